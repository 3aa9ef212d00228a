// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/formats/exporter.hpp"

namespace coupler::formats {

/// `modbus:` of Home Assistant's configuration.yaml: coils are switches, discrete inputs and bits binary
/// sensors, registers sensors.
Export write_home_assistant(const Map& map);

}  // namespace coupler::formats
