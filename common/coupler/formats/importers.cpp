// SPDX-License-Identifier: Apache-2.0
#include "coupler/formats/importers.hpp"

#include <algorithm>
#include <iterator>

namespace coupler::formats {
namespace {

constexpr Importer table[] = {
    {"csv", "a table of points: one row a point, one column a key", read_csv},
    {"origin", "bitmeal/ros-modbus-device-driver, YAML or JSON", read_origin},
    {"unslave", "Unslave's config.json", read_unslave},
#ifdef COUPLER_WITH_PUGIXML
    {"modbuspal", "a ModbusPal project (.xmpp)", read_modbuspal},
#endif
};

}  // namespace

Span<const Importer> importers() { return table; }

const Importer* find_importer(std::string_view name) {
  const auto* found = std::find_if(std::begin(table), std::end(table),
                                   [name](const Importer& importer) { return importer.name == name; });
  return found == std::end(table) ? nullptr : found;
}

}  // namespace coupler::formats
