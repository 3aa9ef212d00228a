// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/survey/units.hpp"

#include <optional>

namespace coupler::survey {
namespace {

/// Whether the unit is there; nullopt: the survey has to end.
std::optional<bool> ask_unit(Inquiry& inquiry, bool is_only_one) {
  for (const Table table :
       {Table::holding_registers, Table::input_registers, Table::coils, Table::discrete_inputs}) {
    std::uint16_t value = 0;
    const Reply reply = inquiry.try_read(table, modbus::Range::of(0, 1), &value);
    if (reply.kind == Reply::Kind::over) return std::nullopt;
    if (reply.is_given()) return true;
    if (reply.kind == Reply::Kind::refused) return !host::is_unit_away(host::ExceptionReply{reply.exception});
    if (reply.timed_out && !is_only_one) return false;
  }
  return false;
}

}  // namespace

std::vector<std::uint8_t> find_units(Inquiry& inquiry, Watcher& watcher,
                                     const std::vector<std::uint8_t>& units) {
  watcher.begins("unit ids");
  std::vector<std::uint8_t> found;
  std::uint32_t asked = 0;
  for (const std::uint8_t unit : units) {
    inquiry.select(unit);
    const auto is_there = ask_unit(inquiry, units.size() == 1);
    if (!is_there) break;
    if (*is_there) found.push_back(unit);
    watcher.moved(++asked, static_cast<std::uint32_t>(units.size()), inquiry.requests());
  }
  return found;
}

}  // namespace coupler::survey
