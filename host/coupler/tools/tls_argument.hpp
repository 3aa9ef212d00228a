// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "coupler/map/node_address.hpp"
#include "coupler/map/tls_texts.hpp"
#include "coupler/tools/commands.hpp"

namespace coupler::tools {

/// Adds the options for a connection with TLS, which replace what the map says. `arguments` must outlive the
/// call of the command.
void add_tls_options(command_line::Command& command, TlsTexts& arguments);

bool any_given(const TlsTexts& arguments);

/// Returns what is missing for a place with tls://, and what to do; nullopt if nothing is.
std::optional<std::string> tls_problem(const Tls& tls);

/// Overrides `tls` with the options. Returns what is wrong, or nullopt if the result fits the place.
std::optional<Failure> use_tls_options(const NodeAddress& where, const TlsTexts& arguments, Tls& tls);

}  // namespace coupler::tools
