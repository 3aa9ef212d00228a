// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "coupler/map/node_address.hpp"
#include "coupler/map/tls_texts.hpp"
#include "coupler/tools/commands.hpp"

namespace coupler::tools {

/// How a command proves itself to a device with TLS: options in place of what the map says. `arguments`
/// outlive the call of the command.
void add_tls_options(command_line::Command& command, TlsTexts& arguments);

bool any_given(const TlsTexts& arguments);

/// Returns what is missing for a place with tls://, and what to do; nullopt if nothing is.
std::optional<std::string> tls_problem(const Tls& tls);

/// Puts the options in the place of what `tls` says. nullopt: the two and the place fit together.
std::optional<Failure> use_tls_options(const NodeAddress& where, const TlsTexts& arguments, Tls& tls);

}  // namespace coupler::tools
