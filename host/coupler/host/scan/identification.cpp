// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/scan/identification.hpp"

#include <array>

#include <fmt/format.h>

namespace coupler::scan {
namespace {

using Access = modbus::ReadDeviceIdentification::Access;

/// Reads the objects of a category. Returns whether the device has it.
bool read_stream(const AskIdentification& ask, Access access, std::map<std::uint8_t, std::string>& objects) {
  for (std::optional<std::uint8_t> from = std::uint8_t{0}; from;) {
    auto page = ask({access, *from});
    if (!page) return false;
    objects.merge(page->objects);
    // A stream that does not go forward would never end.
    from = page->next && *page->next > *from ? page->next : std::nullopt;
  }
  return true;
}

}  // namespace

std::map<std::uint8_t, std::string> read_identification(const AskIdentification& ask) {
  std::map<std::uint8_t, std::string> objects;
  for (const Access access : {Access::basic, Access::regular, Access::extended})
    if (!read_stream(ask, access, objects)) break;
  return objects;
}

std::map<std::uint8_t, std::string> read_identification(Prober& prober) {
  return read_identification(
      [&](modbus::ReadDeviceIdentification wanted) -> std::optional<IdentificationPage> {
        IdentificationPage page;
        if (!prober.identify(wanted, page).is_given()) return std::nullopt;
        return page;
      });
}

std::string object_name(std::uint8_t id) {
  constexpr std::array<std::string_view, 7> names{
      "VendorName",  "ProductCode", "MajorMinorRevision",  "VendorUrl",
      "ProductName", "ModelName",   "UserApplicationName",
  };
  return id < names.size() ? std::string(names[id]) : fmt::format("object {:02X}", id);
}

std::optional<identity::Head> read_node_identity(Prober& prober) {
  std::array<std::uint16_t, identity::head_size> area{};
  const auto range = modbus::Range::of(identity::reserved.start(), identity::head_size);
  if (!prober.read(Table::input_registers, range, area.data()).is_given()) return std::nullopt;
  return identity::read_head(area);
}

}  // namespace coupler::scan
