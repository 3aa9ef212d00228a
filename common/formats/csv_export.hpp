// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/formats/exporter.hpp"

namespace coupler::formats {

/// The table that `coupler import csv` reads: all that the map says of its points, with addresses as on the
/// wire and orders written out, so that the map made from it has the same fingerprint.
Export write_csv(const Map& map);

}  // namespace coupler::formats
