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

void PacedTransport::ended_at(Time time, Duration rest) {
  answered_ = time;
  ready_ = rest > Duration::zero() ? time + rest : Time::min();
}

Result<> PacedTransport::answered(Result<> result) {
  ended_at(clock_.now(), gap_);
  if (const ExceptionReply* exception = result ? nullptr : exception_in(result.error()))
    seen_.set(static_cast<std::size_t>(exception->code));
  statistics_.answered(answered_ - begun_, result);
  const bool is_reply = result || exception_in(result.error()) != nullptr;
  if (is_reply) ++replies_;
  unit_answers_ = is_reply && (result || !is_unit_away(result.error()));
  give(transport_.take_wait_answer());
  return result;
}

void PacedTransport::give(const std::optional<WaitAnswer>& answer) {
  if (!answer || listener_ == nullptr) return;
  ++replies_;
  listener_->on_wait_answer(*answer);
}

Result<> PacedTransport::connect() {
  unit_answers_ = false;
  Result<> result = transport_.connect();
  ended_at(clock_.now(), delay_);
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
  Result<> result = answered(transport_.receive(request));
  written_ = stamp_between(begun_, answered_);
  return result;
}

Result<modbus::ScheduleReply> PacedTransport::schedule(const modbus::ScheduleRequest& request) {
  pause();
  Result<modbus::ScheduleReply> reply = transport_.schedule(request);
  if (const auto taken = answered(reply ? Result<>{} : tl::make_unexpected(reply.error())); !taken)
    return tl::make_unexpected(taken.error());
  return reply;
}

Result<> PacedTransport::send_wait(const modbus::ChangesRequest& request) {
  pause();
  return transport_.send_wait(request);
}
Result<> PacedTransport::receive_wait() {
  if (Result<> received = transport_.receive_wait(); !received) return answered(received);
  const auto answer = transport_.take_wait_answer();
  if (answer) ended_at(answer->received, gap_);
  give(answer);
  return {};
}

Result<> PacedTransport::keep_alive(const Map& map) {
  const auto found = std::find_if(map.points.begin(), map.points.end(), is_readable);
  const Point* const point = found == map.points.end() ? map.points.begin() : found;
  return map.points.empty() ? ask({Table::coils, modbus::Range::of(0, 1)})
                            : ask({point->table, read_range(*point)});
}

Result<> PacedTransport::ask(const Unreadable& place) {
  std::array<std::uint16_t, modbus::max_read_bits> ignored;
  Result<> answer = read(place.table, place.range, ignored.data());
  if (answer || (exception_in(answer.error()) != nullptr && !is_unit_away(answer.error()))) return {};
  return answer;
}

}  // namespace coupler::host
