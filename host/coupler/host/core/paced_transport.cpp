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

void PacedTransport::answered(const Error* error) {
  ended_at(clock_.now(), gap_);
  const ExceptionReply* exception = error != nullptr ? exception_in(*error) : nullptr;
  if (exception != nullptr) seen_.set(static_cast<std::size_t>(exception->code));
  statistics_.answered(answered_ - begun_, error);
  const bool is_reply = error == nullptr || exception != nullptr;
  if (is_reply) ++replies_;
  unit_answers_ = is_reply && (exception == nullptr || !is_unit_away(*error));
  give(transport_.take_wait_answer());
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

Result<modbus::Bytes> PacedTransport::exchange(modbus::Bytes pdu) {
  pause();
  return answered(transport_.exchange(pdu));
}

Result<> PacedTransport::send_pdu(modbus::Bytes pdu) {
  pause();
  return transport_.send_pdu(pdu);
}

Result<modbus::Bytes> PacedTransport::receive_pdu() {
  auto reply = answered(transport_.receive_pdu());
  written_ = stamp_between(begun_, answered_);
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
