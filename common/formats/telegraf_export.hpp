// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/formats/exporter.hpp"

namespace coupler::formats {

/// A section [[inputs.modbus]] for Telegraf, in the plugin's "request" style: one request for each table and
/// byte order, which Telegraf parts into as many reads as it needs.
Export write_telegraf(const Map& map);

}  // namespace coupler::formats
