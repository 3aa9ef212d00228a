// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/core/request_text.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "coupler/map/functions.hpp"
#include "coupler/modbus/server.hpp"

namespace coupler::host {

std::string request_text(modbus::Bytes pdu) {
  const auto request = modbus::parse_request(pdu);
  if (const auto* read = request ? std::get_if<modbus::Read>(&*request) : nullptr)
    return fmt::format("read {} {} to {}", to_string(table_of(read->function)), read->range.start(),
                       read->range.last());
  if (const auto* groups = request ? std::get_if<modbus::FileGroups>(&*request) : nullptr) {
    const modbus::FileRecord wanted = (*groups)[0];
    return fmt::format("read file {} from {}, {} registers", wanted.file, wanted.record, wanted.registers);
  }
  if (pdu[0] == static_cast<std::uint8_t>(modbus::Function::schedule_output))
    return fmt::format("schedule: {:02x}", fmt::join(pdu.begin() + 1, pdu.end(), " "));
  return fmt::format("write by FC {} at {}: {:02x}", pdu[0], modbus::get_u16(&pdu[1]),
                     fmt::join(pdu.begin() + 3, pdu.end(), " "));
}

}  // namespace coupler::host
