// SPDX-License-Identifier: Apache-2.0
// A simulated connection to a simulated node that carries out outputs at their times, with faults. The clock
// is the simulation's.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <optional>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "coupler/host/core/call_queue.hpp"
#include "coupler/host/core/scheduled.hpp"

namespace coupler::host {

/// What happens, in the order of time.
class SimulatedTime {
 public:
  explicit SimulatedTime(Time now) : now_(now) {}

  Time now() const { return now_; }
  void at(Time when, std::function<void()> what) { events_.emplace(when, std::move(what)); }
  void in(Duration after, std::function<void()> what) { at(now_ + after, std::move(what)); }
  /// Returns when the next event is; at the end of all Time::max().
  Time next() const { return events_.empty() ? Time::max() : events_.begin()->first; }
  void advance(Time to) { now_ = std::max(now_, to); }
  void happen() {
    const auto what = std::move(events_.begin()->second);
    events_.erase(events_.begin());
    what();
  }

 private:
  Time now_;
  std::multimap<Time, std::function<void()>> events_;
};

/// Random numbers that are the same in each run.
class Chance {
 public:
  explicit Chance(unsigned seed) : random_(seed) {}

  int pick(int least, int most) { return std::uniform_int_distribution<int>(least, most)(random_); }
  double real(double least, double most) {
    return std::uniform_real_distribution<double>(least, most)(random_);
  }
  bool is(double of_one) { return real(0, 1) < of_one; }

 private:
  std::mt19937 random_;
};

/// The driver makes one request at a time, those that cancel first, as OutputScheduler does.
class SimulatedOutputs {
 public:
  using Result = ScheduledOutcome::Result;
  struct Events {
    std::function<void(const ScheduledWrite&)> driven;                            ///< a line is, at its time
    std::function<void(const ScheduledWrite&)> refused;                           ///< the call is answered so
    std::function<void(const ScheduledOutcome&, const ScheduledWrite&)> outcome;  ///< the driver hears of it
    std::function<void(const std::string&)> wrong;
  };

  SimulatedOutputs(SimulatedTime& time, Chance& chance, Duration delay, Events events)
      : time_(time), chance_(chance), delay_(delay), events_(std::move(events)) {}

  void schedule(const ScheduledWrite& what, Reply<ScheduleAnswer>::Give give) {
    calls_.push_back({what, {}, std::move(give), {}});
    if (!online_) return refuse_all();
    ask();
  }
  void cancel(const WritesFrom& which, const Reply<CallAnswer>::Give& give) {
    if (!online_) return give({false, "not connected"});
    std::deque<Call> kept;
    std::deque<Call> refused;
    for (Call& call : calls_)
      (call.write && which.has(*call.write) ? refused : kept).push_back(std::move(call));
    calls_ = std::move(kept);
    calls_.push_front({{}, which, {}, give});
    for (const Call& call : refused) answer(call, {0, "cancelled before it was accepted"});
    ask();
  }
  /// The driver hears it later, unless the connection ends.
  void tell(std::function<void()> what) {
    if (!online_) return;
    time_.in(delay_, [this, connection = connection_, what = std::move(what)] {
      if (connection == connection_) what();
    });
  }

  // Faults.

  /// Somebody writes the point.
  void overwrite(std::uint32_t point) {
    cancel_if([point](const Output& output) { return output.what.write.point == point; }, "overwritten");
  }
  /// Others have so many of the node's places.
  void occupy(std::size_t count) { others_ = count; }
  void fail(double part_of_outputs) { fails_ = part_of_outputs; }
  /// The cable is pulled: the node knows it after a while.
  void cut(Duration unnoticed) {
    ++connection_;
    online_ = false;
    time_.in(unnoticed, [this] { outputs_.clear(); });
    if (asking_) calls_.push_front(*std::exchange(asking_, std::nullopt));
    refuse_all();
    for (const Output& output : std::exchange(accepted_, {}))
      events_.outcome(outcome(output, Result::unknown, "the connection ended"), output.what);
  }
  void plug() { online_ = true; }
  bool is_online() const { return online_; }

 private:
  struct Call {
    std::optional<ScheduledWrite> write;
    WritesFrom cancels;
    Reply<ScheduleAnswer>::Give answer_write;
    Reply<CallAnswer>::Give answer_cancel;
  };
  struct Output {
    ScheduledWrite what;
    std::uint32_t number;
  };
  static constexpr std::size_t places = 64;

  // At the driver.

  void ask() {
    if (asking_ || calls_.empty()) return;
    asking_ = std::move(calls_.front());
    calls_.pop_front();
    time_.in(delay_ + lateness(), [this, connection = connection_] {
      if (connection == connection_) arrive();
    });
  }
  void answer(const Call& call, const ScheduleAnswer& answer) {
    if (!call.write) return call.answer_cancel({answer.number != 0, answer.text});
    if (answer.number == 0)
      events_.refused(*call.write);
    else
      accepted_.push_back({*call.write, answer.number});
    call.answer_write(answer);
  }
  void refuse_all() {
    while (!calls_.empty()) {
      const Call call = std::move(calls_.front());
      calls_.pop_front();
      answer(call, {0, "not connected"});
    }
  }
  void hear(const ScheduledOutcome& told, const ScheduledWrite& what) {
    const auto is_it = [&told](const Output& one) { return one.number == told.number; };
    accepted_.erase(std::remove_if(accepted_.begin(), accepted_.end(), is_it), accepted_.end());
    heard_ = time_.now();
    events_.outcome(told, what);
  }

  // At the node.

  void arrive() {
    if (!asking_->write) {
      cancel_if([this](const Output& output) { return asking_->cancels.has(output.what); }, "by its client");
      return reply({1, "cancelled"});
    }
    const ScheduledWrite& what = *asking_->write;
    const Time now = time_.now();
    if (outputs_.size() + others_ >= places) {
      Time& before = lacked_room_[{what.due, what.write.point}];
      if (before > now - std::chrono::milliseconds(10) && before > heard_)
        events_.wrong("it is asked again without a pause");
      before = now;
      return reply({0, "too many", false, true});
    }
    if (what.due + what.may_be_late < now) return reply({0, "its time has passed"});
    outputs_.push_back({what, ++last_number_});
    reply({last_number_, "accepted", true});
    time_.at(std::max(now, what.due) + lateness(), [this] { drive_due(); });
  }
  void reply(ScheduleAnswer said) {
    tell([this, said = std::move(said)] {
      answer(*std::exchange(asking_, std::nullopt), said);
      ask();
    });
  }
  void drive_due() {
    const auto is_earlier = [](const Output& a, const Output& b) { return a.what.due < b.what.due; };
    for (;;) {
      const auto first = std::min_element(outputs_.begin(), outputs_.end(), is_earlier);
      if (first == outputs_.end() || first->what.due > time_.now()) return;
      const Output output = *first;
      outputs_.erase(first);
      if (chance_.is(fails_)) {
        tell_outcome(output, Result::failed, "the line is gone");
      } else {
        events_.driven(output.what);
        tell_outcome(output, Result::done, "");
      }
    }
  }
  template <class Which>
  void cancel_if(Which which, const char* why) {
    for (const Output& output : outputs_)
      if (which(output)) tell_outcome(output, Result::cancelled, why);
    outputs_.erase(std::remove_if(outputs_.begin(), outputs_.end(), which), outputs_.end());
  }
  void tell_outcome(const Output& output, Result result, const char* reason) {
    tell([this, told = outcome(output, result, reason), what = output.what] { hear(told, what); });
  }
  ScheduledOutcome outcome(const Output& output, Result result, const char* reason) const {
    const ScheduledWrite& what = output.what;
    return {output.number, what.write.point, result, reason, what.asked, what.due, {time_.now(), {}}};
  }
  Duration lateness() { return std::chrono::microseconds(chance_.pick(0, 200)); }

  SimulatedTime& time_;
  Chance& chance_;
  const Duration delay_;
  const Events events_;

  bool online_ = true;
  unsigned connection_ = 0;
  std::deque<Call> calls_;
  std::optional<Call> asking_;
  std::vector<Output> accepted_;  ///< those that the driver knows to wait
  Time heard_{};                  ///< the driver heard an outcome

  std::vector<Output> outputs_;
  std::uint32_t last_number_ = 0;
  std::size_t others_ = 0;
  double fails_ = 0;
  std::map<std::pair<Time, std::uint32_t>, Time> lacked_room_;  ///< by due time and point: when
};

}  // namespace coupler::host
