// SPDX-License-Identifier: Apache-2.0
#include "host/survey/units.hpp"

namespace coupler::survey {

std::vector<UnitAnswer> find_units(Inquiry& inquiry, Watcher& watcher,
                                   const std::vector<std::uint8_t>& units) {
  watcher.begins("unit ids");
  std::vector<UnitAnswer> answers;
  std::uint32_t asked = 0;
  for (const std::uint8_t unit : units) {
    inquiry.select(unit);
    std::uint16_t value = 0;
    const Reply reply = inquiry.try_read(Table::holding_registers, modbus::Range::of(0, 1), &value);
    if (reply.kind == Reply::Kind::over) break;
    const bool refuses =
        reply.kind == Reply::Kind::refused && !driver::is_unit_away(driver::ExceptionReply{reply.exception});
    if (reply.is_given()) answers.push_back({unit, std::nullopt});
    if (refuses) answers.push_back({unit, reply.exception});
    watcher.moved(++asked, static_cast<std::uint32_t>(units.size()), inquiry.requests());
  }
  return answers;
}

}  // namespace coupler::survey
