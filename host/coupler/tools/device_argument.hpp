// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>

#include <tl/expected.hpp>

#include "coupler/tools/map_argument.hpp"

namespace coupler::tools {

/// The arguments of a command that reads a device. They must outlive the call of the command.
struct DeviceArgument {
  std::string map;
  std::string at;
  TlsTexts tls;
};

void add_device_options(command_line::Command& command, DeviceArgument& arguments);

struct DeviceMap {
  MapArgument argument;                   ///< owns the texts that `map` views
  std::shared_ptr<const std::string> at;  ///< the place of --at, which `map` views, too
  Map map;                                ///< has the connection that the options give
};

/// Returns the map of a device. If there is none, says why, as `command`, and returns the exit status.
tl::expected<DeviceMap, Exit> get_device(std::string_view command, const DeviceArgument& arguments);

}  // namespace coupler::tools
