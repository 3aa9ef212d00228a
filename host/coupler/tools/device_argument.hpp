// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>

#include <tl/expected.hpp>

#include "coupler/tools/map_argument.hpp"

namespace coupler::tools {

/// A device and its map, as commands take them that read it. The call of the command must end before it.
struct DeviceArgument {
  std::string map;
  std::string at;
  TlsTexts tls;
  bool may_be_unknown = false;  ///< `map` may be the place of a device whose map is found out
};

void add_device_options(command_line::Command& command, DeviceArgument& arguments);

struct DeviceMap {
  MapArgument argument;                   ///< has what `map` views
  std::shared_ptr<const std::string> at;  ///< and so has this
  Map map;                                ///< with the connection that the options say
};

/// Error: the exit status of `command`, after it is said why.
tl::expected<DeviceMap, Exit> get_device(std::string_view command, const DeviceArgument& arguments);

}  // namespace coupler::tools
