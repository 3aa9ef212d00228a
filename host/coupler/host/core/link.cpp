// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/core/link.hpp"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "coupler/host/core/request_text.hpp"

namespace coupler::host {
namespace {

/// A node carries it out although its confirmation comes late.
bool changes_outputs(modbus::Bytes pdu) {
  return pdu[0] == static_cast<std::uint8_t>(modbus::Function::schedule_output);
}

}  // namespace

Link::Link(std::shared_ptr<SharedChannel> shared, const Connection& unit, const Limits& limits, Clock* clock)
    : shared_(std::move(shared)),
      unit_(unit.unit),
      timeout_(unit.timeout),
      gap_(limits.request_gap),
      delay_(limits.connect_delay),
      own_clock_(clock == nullptr ? std::make_unique<SteadyClock>() : nullptr),
      clock_(clock == nullptr ? *own_clock_ : *clock) {}

// The connection.

Result<> Link::connect() {
  close();
  unit_answers_ = false;
  const Time begun = clock_.now();
  pause_until(late_until_);
  Result<> result = take_turn(Rank::read);
  if (result) {
    result = channel().select(unit_, timeout_);
    if (result && !shared_->is_open) result = open();
    if (result) {
      is_connected_ = true;
      losses_at_connect_ = shared_->losses;
      ++shared_->users;
    }
    release();
  }
  pause_after(clock_.now(), delay_);
  write_trace(result ? nullptr : &result.error(), begun, [] { return std::string("connect"); });
  return result;
}

Result<> Link::open() {
  const Time begun = clock_.now();
  Result<> opened = channel().open(interrupted_);
  shared_->is_open = opened.has_value();
  shared_->opened = clock_.now();
  // Counts as a loss for all links of the channel: each of them would wait just as long, in vain.
  if (!opened && shared_->opened - begun >= timeout_) ++shared_->losses;
  return opened;
}

void Link::close() {
  if (has_turn_) {
    give_back();
  } else if (shared_->turns.is_held_by(this)) {  // a request is in progress, or has thrown an exception
    unanswered();
    release();
  }
  if (!std::exchange(is_connected_, false) || --shared_->users > 0) return;
  // It does not wait for its turn: a lost unit is to be reported at once. If another unit has the turn, that
  // one goes on with the channel, or closes it.
  if (shared_->turns.try_take(this)) release();
}

void Link::interrupt() {
  interrupted_.set();
  if (own_clock_) own_clock_->stop();
  shared_->turns.interrupt(this, [this] { channel().hang_up(); });
}

// A request.

void Link::pause_until(Time time) {
  if (time > Time{} && time > clock_.now()) clock_.sleep_until(time);
}

void Link::pause_after(Time time, Duration pause) {
  answered_ = time;
  ready_ = pause > Duration::zero() ? time + pause : Time::min();
}

Result<> Link::begin(Rank rank) {
  pause_until(ready_);
  Result<> ready = take_turn(rank);
  if (ready) {
    ready = prepare();
    if (!ready) release();
  }
  sent_at_ = clock_.now();
  return ready;
}

Result<> Link::prepare() {
  if (!is_connected_) return fail(NotConnected{"not connected"});
  if (is_lost()) return give_up_error();
  if (auto selected = channel().select(unit_, timeout_); !selected) return selected;
  if (!shared_->is_open)
    if (auto opened = open(); !opened) return opened;
  pause_until(channel_ready());
  if (interrupted_.is_set()) return give_up_error();
  return {};
}

Result<> Link::put(Rank rank, modbus::Bytes pdu, bool owner_waits) {
  std::copy(pdu.begin(), pdu.end(), request_.begin());
  request_size_ = pdu.size();
  if (auto begun = begin(rank); !begun) return begun;
  Result<> sent = channel().send(pdu);
  if (!sent && owner_waits && is_polled())
    release();  // the owner, which polls the channel, has to close it
  else if (!sent)
    end_turn(clock_.now(), &sent.error());
  return sent;
}

Result<modbus::Bytes> Link::exchange(modbus::Bytes pdu) {
  const Result<> sent = put(rank_, pdu);
  if (sent) return finish(!changes_outputs(pdu));
  count(clock_.now(), &sent.error());
  trace_request(&sent.error());
  return tl::make_unexpected(sent.error());
}

Result<> Link::send(const modbus::WriteRequest& request) {
  const bool was_reserved = std::exchange(is_reserved_, false);
  if (auto sent = put(Rank::write, request.pdu(), was_reserved); !sent) return sent;
  if (was_reserved && !is_polled()) wake();  // no thread polls the channel: the owner must call receive()
  return {};
}

Result<> Link::receive() {
  if (!is_connected_) return fail(NotConnected{"not connected"});  // close() has ended the request
  const auto reply = finish(false);
  written_ = stamp_between(sent_at_, answered_);
  if (!reply) return tl::make_unexpected(reply.error());
  return {};
}

Result<modbus::Bytes> Link::receive_checked(bool is_read) {
  auto reply = channel().receive();
  if (!reply) return reply;
  const modbus::Bytes asked = modbus::Bytes(request_).first(request_size_);
  const auto answers = modbus::check_reply(asked, *reply);
  if (!answers) return tl::make_unexpected(error_of(answers.error(), asked, *reply));
  if (is_read && channel().is_late()) return fail(Timeout{timeout_});
  return reply;
}

Result<modbus::Bytes> Link::finish(bool is_read) {
  auto reply = receive_checked(is_read);
  if (reply && shared_->has_several_links) {
    std::copy(reply->begin(), reply->end(), reply_.begin());
    *reply = modbus::Bytes(reply_).first(reply->size());
  }
  const auto before = channel().take_wait_answer();
  const Error* const error = reply ? nullptr : &reply.error();
  const Time now = clock_.now();
  end_turn(now, error);
  count(now, error);
  trace_request(error);
  hand_over(before);
  return reply;
}

void Link::end_turn(Time now, const Error* error) {
  shared_->answered = now;
  const bool is_reply = error == nullptr || exception_in(*error) != nullptr;
  if (!is_reply && std::holds_alternative<TransportFailure>(*error)) {
    channel().close();
    shared_->is_open = false;
    if (!interrupted_.is_set()) ++shared_->losses;
  } else if (!is_reply || !channel().is_trusted()) {
    unanswered();
  }
  release();
}

void Link::unanswered() {
  if (channel().is_bus()) {
    late_until_ = clock_.now() + timeout_;
    return;
  }
  if (!shared_->has_several_links && channel().is_trusted())
    return;  // a late reply is recognized by its transaction number
  channel().close();
  shared_->is_open = false;
}

void Link::count(Time now, const Error* error) {
  pause_after(now, gap_);
  const ExceptionReply* exception = error != nullptr ? exception_in(*error) : nullptr;
  if (exception != nullptr) seen_.set(static_cast<std::size_t>(exception->code));
  const bool is_answer = error != nullptr && may_be_refused_ && is_unit_refusal(*error);
  {
    const std::lock_guard lock(counts_mutex_);
    counts_.add(answered_ - sent_at_, is_answer ? nullptr : error);
  }
  const bool is_reply = error == nullptr || exception != nullptr;
  if (is_reply) ++replies_;
  unit_answers_ = is_reply && (exception == nullptr || !is_unit_away(*error));
}

void Link::trace_request(const Error* error) const {
  write_trace(error, sent_at_, [this] { return request_text(modbus::Bytes(request_).first(request_size_)); });
}

template <class Describe>
void Link::write_trace(const Error* error, Time begun, Describe describe) const {
  if (!trace_.is_wanted || !trace_.is_wanted()) return;
  const std::chrono::duration<double, std::milli> took = clock_.now() - begun;
  trace_.write(fmt::format("{}: {} after {:.3f} ms", describe(),
                           error == nullptr ? std::string("ok") : to_string(*error), took.count()));
}

// Waits for changes.

Result<> Link::send_wait(const modbus::ChangesRequest& request) {
  if (auto begun = begin(Rank::read); !begun) return begun;
  Result<> sent = channel().send_wait(request);
  release();
  return sent;
}

Result<> Link::receive_wait() {
  if (auto taken = take_turn(Rank::read); !taken) return taken;
  Result<> received = channel().receive_wait();
  const auto answer = channel().take_wait_answer();
  const Time now = clock_.now();
  shared_->answered = now;
  if (received && !channel().is_trusted()) unanswered();
  release();
  if (received) {
    pause_after(now, gap_);
  } else {
    count(now, &received.error());
    write_trace(&received.error(), sent_at_, [] { return std::string("wait for changes"); });
  }
  hand_over(answer);
  return received;
}

void Link::hand_over(const std::optional<WaitAnswer>& answer) {
  if (!answer || listener_ == nullptr) return;
  ++replies_;
  write_trace(answer->reply ? nullptr : &answer->reply.error(), answer->sent,
              [&] { return fmt::format("wait for changes: {}", answer->reply ? answer->reply->count : 0); });
  listener_->on_wait_answer(*answer);
}

}  // namespace coupler::host
