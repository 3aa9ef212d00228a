// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/formats/importer.hpp"

namespace coupler::formats {

/// The origin's files (bitmeal/ros-modbus-device-driver), and maps of this project: they are written again in
/// one style. Comments are told, and go.
std::vector<ForeignUnit> read_origin(std::string_view text, loader::Problems& problems);

}  // namespace coupler::formats
