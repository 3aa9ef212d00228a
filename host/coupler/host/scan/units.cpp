// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/scan/units.hpp"

#include <optional>

namespace coupler::scan {
namespace {

/// Whether the unit is there; nullopt: the scan has to end.
std::optional<bool> ask_unit(Prober& prober, bool is_only_one) {
  for (const Table table :
       {Table::holding_registers, Table::input_registers, Table::coils, Table::discrete_inputs}) {
    std::uint16_t value = 0;
    const Reply reply = prober.try_read(table, modbus::Range::of(0, 1), &value);
    if (reply.kind == Reply::Kind::over) return std::nullopt;
    if (reply.is_given()) return true;
    if (reply.kind == Reply::Kind::refused) return !host::is_unit_away(host::ExceptionReply{reply.exception});
    if (reply.timed_out && !is_only_one) return false;
  }
  return false;
}

}  // namespace

std::vector<std::uint8_t> find_units(Prober& prober, ScanProgress& progress,
                                     const std::vector<std::uint8_t>& units) {
  progress.begins("unit ids");
  std::vector<std::uint8_t> found;
  std::uint32_t asked = 0;
  for (const std::uint8_t unit : units) {
    prober.select(unit);
    const auto is_there = ask_unit(prober, units.size() == 1);
    if (!is_there) break;
    if (*is_there) found.push_back(unit);
    progress.moved(++asked, static_cast<std::uint32_t>(units.size()), prober.requests());
  }
  return found;
}

}  // namespace coupler::scan
