// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/core/output_scheduler.hpp"

#include <algorithm>
#include <array>
#include <exception>
#include <numeric>
#include <utility>

#include <fmt/format.h>

#include "coupler/base/what_failed.hpp"
#include "coupler/map/typed_value.hpp"
#include "coupler/modbus/scheduled_output.hpp"

namespace coupler::host {
namespace {

using modbus::Exception;

constexpr auto the_driver_ends = "the driver ends";
constexpr auto made_safe = "safe values have been written meanwhile; ask again if it is still wanted";
constexpr auto cancelled_first = "cancelled before it was accepted";

std::string refusal(modbus::Exception code) {
  std::string what = to_string(Error(ExceptionReply{code}));
  switch (code) {
    case Exception::illegal_function: return what + ": this certificate has no right to write it";
    case Exception::illegal_data_address: return what + ": its map has no such output";
    case Exception::illegal_data_value:
      return what +
             ": it does not take that value, its time had passed when the request arrived, its clock has "
             "jumped or "
             "it has just read a new map; try again with a later time";
    case Exception::server_device_failure:
      return what +
             ": its watchdog keeps outputs in their safe state until it is reset, or its hardware is gone";
    case Exception::server_device_busy:
      return what + ": too many outputs are scheduled there; ask again when one of them is over";
    default: return what;
  }
}

/// Makes an answer for a call, which has one then whatever throws.
template <class Answer, class F>
Result<> answered(Reply<Answer>& to, F make) {
  try {
    return make();
  } catch (...) {
    const std::exception_ptr thrown = std::current_exception();
    if (!to.is_given()) to.set_value({{}, std::string(in_doubt) + what_failed(thrown)});
    throw;
  }
}

}  // namespace

OutputScheduler::OutputScheduler(const Map& map, Link& link, Writer& writer, ChangeSink& bits, Sink& sink)
    : map_(map),
      link_(link),
      clock_(link.clock()),
      writer_(writer),
      sink_(sink),
      by_driver_(link, writer, *this),
      by_node_(bits, clock_, *this),
      canceller_(map, link, by_driver_, by_node_) {
  writer.listen(*this);
}

void OutputScheduler::connected(bool by_node) {
  node_can_ = by_node;
  canceller_.connected();
  calls_.open();
  cancels_.open();
  point_cancels_.open();
}

std::vector<WaitingWrite> OutputScheduler::waiting() const {
  std::unique_lock lock(mutex_);
  std::vector<WaitingWrite> waiting = waiting_;
  lock.unlock();
  std::stable_sort(waiting.begin(), waiting.end(), [](const WaitingWrite& a, const WaitingWrite& b) {
    return a.which.what.due < b.which.what.due;
  });
  return waiting;
}

/// Returns the number of the write.
std::uint32_t OutputScheduler::accept(const ScheduledWrite& what, bool by_device) {
  const std::lock_guard lock(mutex_);
  waiting_.push_back({{++last_number_, what}, by_device});
  return last_number_;
}

Result<> OutputScheduler::step(const ChangeListener& listener) {
  const auto any = [](const auto&) { return true; };
  const auto is_next_call = [this](const AskedSchedule& asked) { return is_next(asked); };
  Result<> done;
  if (auto one = cancels_.take_one_of(any)) {
    done = answered(one->answer, [&] { return canceller_.answer(one->what, one->answer, listener); });
  } else if (auto some = point_cancels_.take_one_of(any)) {
    done = answered(some->answer, [&] {
      refuse_waiting(some->what);
      return canceller_.answer(some->what.which, some->answer, listener);
    });
  } else if (auto call = calls_.take_one_of(is_next_call)) {
    done = answered(call->answer, [&] { return answer(call->what.what, call->answer, listener); });
  }
  note();
  return done;
}

void OutputScheduler::refuse_waiting(const AskedCancel& cancelled) {
  const auto is_of_them = [&cancelled](const AskedSchedule& asked) {
    return asked.order <= cancelled.after && cancelled.which.has(asked.what);
  };
  while (auto call = calls_.take_one_of(is_of_them)) call->answer.set_value({0, cancelled_first});
}

std::string OutputScheduler::why_refused(const ScheduledWrite& what, Time now) const {
  if (is_full())
    return fmt::format("{} scheduled writes wait, and more cannot; ask again when one of them is over",
                       max_scheduled);
  if (const auto forbidden = find_forbidden(point(what), what.write.registers.data()))
    return fmt::format("{}; send {}", forbidden_text(point(what), *forbidden), allowed_text(point(what)));
  return why_impossible(what, now);
}

Result<> OutputScheduler::answer(const ScheduledWrite& what, Reply<ScheduleAnswer>& to,
                                 const ChangeListener& listener) {
  if (const std::string why = why_refused(what, clock_.now()); !why.empty()) {
    to.set_value({0, why, false, is_full()});
    return {};
  }
  if (can_node(what, listener)) {
    const Result<std::optional<ScheduleAnswer>> given = give_to_node(what, listener);
    if (!given) {
      to.set_value({0, std::string(in_doubt) + to_string(given.error())});
      return tl::make_unexpected(given.error());
    }
    if (*given) {
      to.set_value(**given);
      return {};
    }
  }
  to.set_value(keep(what));
  return {};
}

/// Parts of a register are for the driver: a request has whole ones. So is what is late already, and what
/// follows it: a write that the driver makes cancels those to the same point that wait at the node.
bool OutputScheduler::can_node(const ScheduledWrite& what, const ChangeListener& listener) const {
  const bool bits = holds_bits(point(what).table);
  const bool is_late = what.may_be_late > Duration::zero() && what.due <= clock_.now();
  return node_can_ && !is_late && !by_driver_.has_point(what.write.point) && !is_partial(point(what)) &&
         listener.epoch() && listener.mapping().node_time(what.due) &&
         range(point(what)).count() <= (bits ? modbus::max_scheduled_bits : modbus::max_scheduled_registers);
}

modbus::ScheduleRequest OutputScheduler::request(const ScheduledWrite& what, modbus::NodeTime due,
                                                 const ChangeListener& listener) const {
  modbus::ScheduleOutput when;
  when.epoch = listener.epoch().value_or(0);
  when.due = due;
  when.duration = what.duration;
  when.range = range(point(what));
  const std::size_t count = when.range.count();
  if (!holds_bits(point(what).table))
    return modbus::ScheduleRequest::registers(when, {what.write.registers.data(), count});
  std::array<std::uint16_t, modbus::max_scheduled_bits> bits{};
  for (std::size_t i = 0; i < count; ++i) bits[i] = what.write.bit(i) ? 1 : 0;
  return modbus::ScheduleRequest::coils(when, {bits.data(), count});
}

Result<std::optional<ScheduleAnswer>> OutputScheduler::give_to_node(const ScheduledWrite& what,
                                                                    const ChangeListener& listener) {
  const modbus::NodeTime due = by_node_.node_due(what.due, listener.mapping()).value_or(modbus::NodeTime{});
  const auto reply = link_.schedule(request(what, due, listener));
  if (reply) {
    const std::uint32_t number = accept(what, true);
    by_node_.add(reply->number, due, {number, what});
    // The answer to the wait has come before that to this request, and was the last one.
    if (!listener.is_active()) by_node_.lose(told_no_more);
    return std::optional(ScheduleAnswer{number, "accepted: the device does it", true});
  }
  const ExceptionReply* exception = exception_in(reply.error());
  if (exception == nullptr || is_unit_away(reply.error())) return tl::make_unexpected(reply.error());
  // A gateway before it does not know the function; or it is this output that this client may not write,
  // which a write will tell. Nothing is between the two ends of TLS.
  if (exception->code == Exception::illegal_function && !map_.connection.tls.present()) return std::nullopt;
  // Its time has passed on the way.
  if (const Time now = clock_.now(); exception->code == Exception::illegal_data_value &&
                                     what.may_be_late > Duration::zero() && what.due <= now &&
                                     now <= what.due + what.may_be_late)
    return std::nullopt;
  return ScheduleAnswer{0, "the device refuses it with " + refusal(exception->code), false,
                        exception->code == Exception::server_device_busy};
}

ScheduleAnswer OutputScheduler::keep(const ScheduledWrite& what) {
  if (what.duration.count() > 0)
    return {0,
            fmt::format("only a coupler-node ends an output by itself, and not a part of a register. Leave "
                        "out the duration (how_long: 0). Schedule a second write of {} to end it",
                        point(what).name)};
  const std::uint32_t number = accept(what, false);
  by_driver_.add({number, what});
  return {number, "accepted: the driver does it"};
}

void OutputScheduler::disconnected(const std::string& why) {
  const std::string closed = fmt::format("not connected: {}; ask again when the device is back", why);
  calls_.close(closed);
  cancels_.close(closed);
  point_cancels_.close(closed);
  if (!busy_) return;
  by_driver_.cancel(to_string(modbus::Reason::connection));
  by_node_.lose("the connection ended before the outcome was reported");
  note();
}

void OutputScheduler::shut_down(bool connected, const ChangeListener& listener) {
  calls_.close(the_driver_ends);
  cancels_.close(the_driver_ends);
  point_cancels_.close(the_driver_ends);
  if (!busy_) return;
  WritesFrom all{std::vector<std::uint32_t>(map_.points.size()), Time::min()};
  std::iota(all.points.begin(), all.points.end(), 0U);
  auto counts = canceller_.cancel_by_driver(all, the_driver_ends);
  if (connected) (void)canceller_.cancel_at_node(all, the_driver_ends, listener, counts);
  by_node_.lose(the_driver_ends);
}

void OutputScheduler::on_outcome(const AcceptedWrite& which, ScheduledOutcome::Result result, Stamp at,
                                 const std::string& reason) {
  const ScheduledWrite& what = which.what;
  {
    const std::lock_guard lock(mutex_);
    waiting_.erase(std::remove_if(waiting_.begin(), waiting_.end(),
                                  [&](const WaitingWrite& one) { return one.which.number == which.number; }),
                   waiting_.end());
  }
  // An output that the node drove for good counts as a write. Its outcome may come late, after a newer write.
  if (result == ScheduledOutcome::Result::done && what.duration.count() == 0 && !which.is_overwritten)
    writer_.remember(what.write);
  sink_.on_scheduled({which.number, what.write.point, result, reason, what.asked, what.due, at});
  note();
}

void OutputScheduler::on_written(const Write& write) {
  by_node_.on_written(write.point);
  if (by_driver_.size() > 0) by_driver_.on_written(write);
}

/// A call that waits is cancelled, too: it came before they were acknowledged.
void OutputScheduler::on_made_safe(const std::vector<Write>& values) {
  const auto is_of_one = [&values](const AskedSchedule& asked) {
    return std::any_of(values.begin(), values.end(),
                       [&](const Write& value) { return value.point == asked.what.write.point; });
  };
  while (auto call = calls_.take_one_of(is_of_one)) call->answer.set_value({0, made_safe});
  for (const Write& value : values) by_node_.on_written(value.point);
  if (by_driver_.size() > 0) by_driver_.on_made_safe(values);
}

}  // namespace coupler::host
