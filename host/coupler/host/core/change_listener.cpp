// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/core/change_listener.hpp"

#include <algorithm>

#include <fmt/format.h>

namespace coupler::host {
namespace {

using std::chrono::milliseconds;

/// An idle node is asked about once in this time.
constexpr milliseconds longest(1000);
/// The wait while the node's watchdog is not known, and the pause after an answer that should not have come.
constexpr milliseconds shortest(10);
/// A third of the shortest watchdog that a map can have. A node that claims another one is not asked without
/// end.
constexpr milliseconds least_longest(3);
/// A gap so long after the last one costs no pause.
constexpr std::chrono::seconds forgiven(10);

}  // namespace

ChangeListener::ChangeListener(milliseconds timeout, Link& link, DeviceStatistics& statistics,
                               ChangeSink& changes, Sink& sink)
    : timeout_(timeout),
      link_(link),
      clock_(link.clock()),
      statistics_(statistics),
      changes_(changes),
      sink_(sink) {
  link_.listen(*this);
}

void ChangeListener::set_watchdog(milliseconds watchdog) {
  asks_for_watchdog_ = false;
  longest_wait_ = std::min(longest, timeout_);
  if (watchdog > milliseconds::zero())
    longest_wait_ = std::min(longest_wait_, std::max(watchdog / 3, least_longest));
  resume_at_ = std::min<Time>(resume_at_, clock_.now() + longest_wait_);
}

void ChangeListener::start(milliseconds watchdog) {
  set_watchdog(watchdog);
  active_ = true;
  waiting_ = false;
  epoch_.reset();
  seen_ = 0;
  resume_at_ = {};
  all_told_ = clock_.now();
  mapping_.forget();
}

Result<> ChangeListener::step() {
  if (!active_) return {};
  const Time now = clock_.now();
  if (waiting_) {
    look_at_ = std::min<Time>(silent_from_, now + timeout_);
    return now < silent_from_ ? Result<>{} : receive();
  }
  if (now < resume_at_) return {};
  // The first one is answered at once.
  const modbus::ChangesRequest request{epoch_ ? wait() : std::uint16_t{0}, epoch_.value_or(0), seen_};
  if (auto sent = link_.send_wait(request); !sent) return sent;
  waiting_ = true;
  look_at_ = clock_.now() + timeout_;
  silent_from_ = look_at_ + milliseconds(request.wait);
  return {};
}

Result<> ChangeListener::receive() {
  alone_ = true;
  Result<> received = link_.receive_wait();
  alone_ = false;
  return received;
}

std::uint16_t ChangeListener::wait() {
  const auto left = std::chrono::ceil<milliseconds>(
      std::clamp<Duration>(changes_.answer_wanted() - clock_.now(), Duration::zero(), longest_wait_));
  return static_cast<std::uint16_t>(std::max(left, milliseconds(1)).count());
}

void ChangeListener::on_wait_answer(const WaitAnswer& answer) {
  waiting_ = false;
  if (!active_) return;
  if (answer.reply) {
    take(*answer.reply, answer);
    return;
  }
  active_ = false;
  sink_.on_note(Level::warning,
                fmt::format("the device says that it reports changes, but answers the question for them with "
                            "{}; its points are polled while this connection lasts",
                            to_string(answer.reply.error())));
  changes_.on_end();
}

void ChangeListener::take(const modbus::ChangesReply& reply, const WaitAnswer& answer) {
  const std::uint64_t last = seen_ + reply.lost + reply.count;
  const bool holds_back = last == seen_ && reply.newest > seen_;  // and would for ever
  // Numbers that do not go on from those before belong to another epoch, whatever it is called.
  const bool counts_anew = epoch_ != reply.epoch || last < seen_ || last > reply.newest || holds_back;
  if (counts_anew) begin_epoch(reply);
  map_clock(reply, answer);
  if (!counts_anew) tell_changes(reply, answer);
  // Nothing comes at the end of the wait only, if all is well.
  const bool brings_nothing = !counts_anew && reply.lost == 0 && reply.count == 0;
  if (brings_nothing && alone_) resume_at_ = std::min<Time>(answer.sent + shortest, silent_from_ - timeout_);
  const bool is_all = seen_ >= reply.newest;
  if (is_all) all_told_ = answer.sent;
  changes_.on_heard(reply.newest, is_all ? std::optional(stamp(reply.replied, answer)) : std::nullopt);
}

void ChangeListener::begin_epoch(const modbus::ChangesReply& reply) {
  const bool is_first = !epoch_;
  epoch_ = reply.epoch;
  seen_ = reply.newest;
  mapping_.forget();
  if (is_first) return;
  pause(longest);
  asks_for_watchdog_ = true;
  longest_wait_ = std::min(longest_wait_, shortest);
  say(epochs_, Level::info, "the device's count of changes starts again; every point is read once");
  changes_.on_new_epoch();
  changes_.on_gap();
}

/// After a gap everything is read: not again and again without end.
void ChangeListener::pause(Duration at_most) {
  const Time now = clock_.now();
  const bool again = gap_at_ && now - *gap_at_ < forgiven;
  pause_ = again ? std::clamp<Duration>(2 * pause_, shortest, at_most) : Duration::zero();
  gap_at_ = now;
  resume_at_ = now + std::min<Duration>(pause_, longest_wait_);
}

void ChangeListener::tell_changes(const modbus::ChangesReply& reply, const WaitAnswer& answer) {
  if (reply.lost > 0) {
    pause(shortest);  // no longer, or the more is lost where an input bounces
    changes_.on_gap();
  }
  seen_ += reply.lost;
  for (const modbus::Change& change : reply.all())
    changes_.on_change(change, ++seen_, stamp(change.at, answer));
  statistics_.heard(reply.count, reply.lost);
}

void ChangeListener::map_clock(const modbus::ChangesReply& reply, const WaitAnswer& answer) {
  const auto outcome = mapping_.add({answer.sent, reply.arrived, reply.replied, answer.received});
  if (outcome == ClockMapping::Outcome::taken) return;
  say(jumps_, Level::warning,
      outcome == ClockMapping::Outcome::jumped
          ? "the device's clock or this machine's has jumped; time stamps before and after do not fit "
            "together"
          : "the times that the device reports make no sense: they are not used as time stamps");
}

void ChangeListener::say(LogLineLimit& lines, Level level, const std::string& text) {
  if (const auto line = lines.say(text, clock_.now())) sink_.on_note(level, *line);
}

void ChangeListener::report_held_back() {
  const Time now = clock_.now();
  if (const auto line = jumps_.due(now)) sink_.on_note(Level::warning, *line);
  if (const auto line = epochs_.due(now)) sink_.on_note(Level::info, *line);
}

/// Nothing that was told has happened after it was received, nor before all was told that had happened. The
/// reply itself is not older than its request: that is `all_told_` then.
Stamp ChangeListener::stamp(modbus::NodeTime at, const WaitAnswer& answer) const {
  const auto mapped = mapping_.map(at);
  if (!mapped) return {answer.received, answer.received - all_told_};
  return {std::min(mapped->at, answer.received), mapped->uncertainty};
}

}  // namespace coupler::host
