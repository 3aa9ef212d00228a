// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "common/formats/csv_import.hpp"
#include "common/formats/importer.hpp"
#include "common/formats/origin_import.hpp"
#include "common/formats/unslave_import.hpp"
#ifdef COUPLER_WITH_PUGIXML
#include "common/formats/modbuspal_import.hpp"
#endif

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
