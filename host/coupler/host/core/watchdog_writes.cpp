// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/core/watchdog_writes.hpp"

#include <fmt/format.h>

namespace coupler::host {
namespace {

using Write = WatchdogSequences::Write;

std::string_view remedy(modbus::Exception code) {
  switch (code) {
    case modbus::Exception::server_device_busy: return "another client owns its outputs, end that one";
    case modbus::Exception::illegal_function:
    case modbus::Exception::illegal_data_address: return "is 'preset' the right one for this coupler?";
    default: return "does another client keep it running? docs/couplers.md says what each coupler needs";
  }
}

}  // namespace

std::string to_string(const RefusedStep& refused) {
  return fmt::format("{} for {} at {} {}; {}", to_string(Error(ExceptionReply{refused.code})),
                     refused.step.value, to_string(refused.step.table), refused.step.address,
                     remedy(refused.code));
}

Result<std::optional<RefusedStep>> write_step(const Write& step, Transport& transport) {
  const auto request = step.table == Table::coils
                           ? modbus::WriteRequest::coil(step.address, step.value != 0)
                           : modbus::WriteRequest::register_value(step.address, step.value);
  Result<> done = transport.send(request);
  if (done) done = transport.receive(request);
  if (done) return std::nullopt;
  const ExceptionReply* exception = exception_in(done.error());
  if (exception == nullptr || is_unit_away(done.error())) return tl::make_unexpected(done.error());
  return RefusedStep{step, exception->code};
}

Result<std::optional<RefusedStep>> write_steps(Span<const Write> steps, Transport& transport) {
  for (const Write& step : steps) {
    const Result<bool> is_so = step.if_different ? has_value(step, transport) : Result<bool>(false);
    if (!is_so) return tl::make_unexpected(is_so.error());
    if (*is_so) continue;
    if (auto done = write_step(step, transport); !done || done->has_value()) return done;
  }
  return std::nullopt;
}

Result<bool> has_value(const Write& place, Transport& transport) {
  const auto range = modbus::Range::of(place.address, 1);
  std::uint16_t value = 0;
  std::uint8_t bit = 0;
  const Result<> read = holds_bits(place.table) ? transport.read_bits(place.table, range, &bit)
                                                : transport.read_registers(place.table, range, &value);
  if (read) return (holds_bits(place.table) ? bit : value) == place.value;
  if (exception_in(read.error()) == nullptr || is_unit_away(read.error()))
    return tl::make_unexpected(read.error());
  return false;
}

}  // namespace coupler::host
