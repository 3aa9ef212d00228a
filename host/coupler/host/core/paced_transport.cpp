// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/core/paced_transport.hpp"

#include <algorithm>
#include <array>

#include "coupler/modbus/limits.hpp"

namespace coupler::host {

void PacedTransport::pause() {
  begun_ = clock_.now();
  if (begun_ >= ready_) return;
  clock_.sleep_until(ready_);
  begun_ = clock_.now();
}

Result<> PacedTransport::answered(Result<> result) {
  answered_ = clock_.now();
  ready_ = gap_ > Duration::zero() ? answered_ + gap_ : Time::min();
  if (const ExceptionReply* exception = result ? nullptr : exception_in(result.error()))
    seen_.set(static_cast<std::size_t>(exception->code));
  statistics_.answered(answered_ - begun_, result);
  if (result || exception_in(result.error()) != nullptr) ++replies_;
  return result;
}

Result<> PacedTransport::connect() {
  Result<> result = transport_.connect();
  answered_ = clock_.now();
  ready_ = delay_ > Duration::zero() ? answered_ + delay_ : Time::min();
  return result;
}

Result<> PacedTransport::read_bits(Table table, modbus::Range range, std::uint8_t* bits) {
  return paced([&] { return transport_.read_bits(table, range, bits); });
}
Result<> PacedTransport::read_registers(Table table, modbus::Range range, std::uint16_t* registers) {
  return paced([&] { return transport_.read_registers(table, range, registers); });
}
Result<> PacedTransport::read_file_record(std::uint16_t file, std::uint16_t record,
                                          Span<std::uint16_t> registers) {
  return paced([&] { return transport_.read_file_record(file, record, registers); });
}

Result<> PacedTransport::send(const modbus::WriteRequest& request) {
  pause();
  return transport_.send(request);
}
Result<> PacedTransport::receive(const modbus::WriteRequest& request) {
  return answered(transport_.receive(request));
}

Result<> PacedTransport::keep_alive(const Map& map) {
  const auto found = std::find_if(map.points.begin(), map.points.end(), is_readable);
  const Point* const point = found == map.points.end() ? map.points.begin() : found;
  std::array<std::uint16_t, modbus::max_read_bits> ignored;
  Result<> answer = map.points.empty() ? read(Table::coils, modbus::Range::of(0, 1), ignored.data())
                                       : read(point->table, read_range(*point), ignored.data());
  if (answer || (exception_in(answer.error()) != nullptr && !is_unit_away(answer.error()))) return {};
  return answer;
}

}  // namespace coupler::host
