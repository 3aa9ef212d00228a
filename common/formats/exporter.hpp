// SPDX-License-Identifier: Apache-2.0
// What a foreign format must bring to be exported to: one function, and its row in exporters.cpp.
#pragma once

#include <string>
#include <string_view>

#include "common/base/span.hpp"
#include "common/formats/losses.hpp"
#include "common/map/map.hpp"

namespace coupler::formats {

struct Export {
  std::string text;
  Losses losses;  ///< what the format cannot say
};

struct Exporter {
  std::string_view name;  ///< at the command line
  std::string_view summary;
  Export (*write)(const Map& map);  ///< the same text for the same map
};

Span<const Exporter> exporters();

/// The exporter of that name, or nullptr.
const Exporter* find_exporter(std::string_view name);

}  // namespace coupler::formats
