// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "coupler/command_line/command_line.hpp"
#include "coupler/map/map.hpp"

namespace coupler::cli {

/// How a command proves itself to a device with TLS: options in place of what the map says.
struct TlsArguments {
  std::string certificate;
  std::string key;
  std::string ca;
  std::string name;
  std::string pin;
};

/// `arguments` outlive the call of the command.
void add_tls_options(command_line::Command& command, TlsArguments& arguments);

/// Puts what is given into `tls`, which views it.
void apply(const TlsArguments& arguments, Tls& tls);

bool any_given(const TlsArguments& arguments);

/// What a place with tls:// misses, and what to do; nullopt: nothing.
std::optional<std::string> tls_problem(const Tls& tls);

}  // namespace coupler::cli
