// SPDX-License-Identifier: Apache-2.0
// Requests and replies of function codes 65 and 66: what is taken is built again as the same bytes, and what
// a server takes it can carry out without looking again.
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <variant>
#include <vector>

#include "coupler/modbus/changes.hpp"
#include "coupler/modbus/limits.hpp"
#include "coupler/modbus/scheduled_output.hpp"
#include "test/fuzz/require.hpp"

namespace coupler::fuzz {
namespace {

using namespace modbus;
using Pdu = std::array<std::uint8_t, max_pdu_size>;

void require_same(Bytes taken, Bytes built) {
  require(std::equal(taken.begin(), taken.end(), built.begin(), built.end()),
          "what is taken is built again as the same bytes");
}

void take_changes(Bytes pdu) {
  Pdu again{};
  if (const auto request = parse_changes_request(pdu)) {
    require(request->wait <= longest_wait, "a wait has its limit");
    // The function code is the caller's to look at.
    require_same(pdu.from(1), Bytes(again.data(), build_changes_request(*request, again)).from(1));
  }
  if (const auto reply = parse_changes_reply(pdu))
    require_same(pdu, Bytes(again.data(), reply_changes(*reply, again)));
}

/// The values as a client gives them.
std::vector<std::uint16_t> values_of(const ScheduleOutput& output) {
  std::vector<std::uint16_t> values(output.range.count());
  const bool bits = output.table == Function::read_coils;
  for (std::size_t i = 0; i < values.size(); ++i)
    values[i] =
        bits ? static_cast<std::uint16_t>(output.values[i / 8] >> i % 8 & 1) : get_u16(&output.values[2 * i]);
  return values;
}

void take_schedule(const ScheduleOutput& output, Bytes pdu) {
  require(output.duration.count() >= 0 && output.duration <= longest_duration, "a duration has its limit");
  const auto values = values_of(output);  // reads no byte that is not there
  if (output.table == Function::read_holding_registers)
    require_same(pdu.from(1), ScheduleRequest::registers(output, values).pdu().from(1));
  else  // the bits that fill the last byte may be anything in a request
    require(ScheduleRequest::coils(output, values).pdu().size() == pdu.size(), "no coil is left out");
}

void take_schedules(Bytes pdu) {
  if (const auto request = parse_schedule_request(pdu)) {
    if (const auto* output = std::get_if<ScheduleOutput>(&*request))
      take_schedule(*output, pdu);
    else if (const auto* one = std::get_if<CancelOutput>(&*request))
      require_same(pdu.from(1), ScheduleRequest::cancel(*one).pdu().from(1));
    else
      require_same(pdu.from(1),
                   ScheduleRequest::cancel_from(std::get<CancelOutputs>(*request)).pdu().from(1));
  }
  Pdu again{};
  if (const auto reply = parse_schedule_reply(pdu))
    require_same(pdu, Bytes(again.data(), reply_schedule(*reply, again)));
}

}  // namespace
}  // namespace coupler::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0 || size > coupler::modbus::max_pdu_size) return 0;
  const coupler::modbus::Bytes pdu(data, size);
  coupler::fuzz::take_changes(pdu);
  coupler::fuzz::take_schedules(pdu);
  return 0;
}
