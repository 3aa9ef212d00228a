// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace coupler::schema {

/// The format of maps as a JSON Schema: draft-07, the newest that yaml-language-server checks without loss.
/// What it refuses the loader refuses too, but for unknown keys in files of ros-modbus-device-driver, which
/// only warn. It sees what is wrong within one point, but compares and adds no numbers; not what several
/// points have to do with each other. Scalars are read as YAML 1.2 does, where `on` and `off` are text.
std::string map_schema();

}  // namespace coupler::schema
