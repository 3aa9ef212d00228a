// SPDX-License-Identifier: Apache-2.0
// The place of a device, as every command takes it: HOST[:PORT][/UNIT], with tcp://, tls:// or rtu+tcp:// in
// front or not, or a serial port as /dev/ttyUSB0[/UNIT], with rtu: in front or not.
#pragma once

#include <memory>
#include <string>

#include <tl/expected.hpp>

#include "coupler/map/node_address.hpp"
#include "coupler/tools/commands.hpp"
#include "coupler/tools/tls_argument.hpp"

namespace coupler::tools {

/// The description of the argument in a help text.
constexpr auto place_help =
    "HOST[:PORT][/UNIT], with tls:// or rtu+tcp:// in front or not, or a serial port as /dev/ttyUSB0[/UNIT]";

struct Place {
  std::shared_ptr<const std::string> text;  ///< as node_argument() completes it; the others view it
  NodeAddress node;
  Connection connection;  ///< its TLS settings view the options
};

/// Returns whether an argument is "-" or has the ending of a map's file, and so cannot be meant as a device.
bool has_name_of_map(const std::string& argument);

/// Returns whether an argument can be a device where a file may stand, too: an address such as tcp://HOST, or
/// a serial port. If there is no such file, any name can be one, unless it is empty, has_name_of_map(), or
/// has a slash and is neither in /dev nor HOST/UNIT.
bool can_be_a_device(const std::string& argument);

/// Understands the argument of a command that asks a device. The error is a wrong place, or TLS options that
/// do not fit it. `tls` must outlive the result.
tl::expected<Place, Failure> get_place(const std::string& argument, const TlsTexts& tls);

/// Returns node_address_text() or a completed argument as one that can be typed in a shell.
std::string as_argument(const std::string& place);

/// Does the same for where a device has answered, with the settings of its serial line.
std::string as_argument(const Connection& where);

}  // namespace coupler::tools
