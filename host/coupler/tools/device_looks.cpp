// SPDX-License-Identifier: Apache-2.0
#include "coupler/tools/device_looks.hpp"

#include <algorithm>
#include <utility>

#include "coupler/plan/explain.hpp"

namespace coupler::tools {
namespace {

using State = Reading::State;

/// Why a point that was asked for has no value.
std::string refusal_text(const host::PointQuality& quality, bool is_node) {
  if (!quality.why.empty() || !quality.last_exception) return quality.why;
  const bool is_right =
      is_node && *quality.last_exception == modbus::Exception::illegal_function;  // a node knows how to read
  return host::to_string(host::Error(host::ExceptionReply{*quality.last_exception})) +
         (is_right ? ": this client has no right to read it" : "");
}

State state_of(const host::ValueTable::Value& value) {
  if (value.has_value()) return State::good;
  return value.read_as == host::PointQuality::State::fault ? State::fault : State::invalid;
}

}  // namespace

DeviceLooks::DeviceLooks(const Map& map, const std::vector<bool>& chosen, const host::ValueTable& values,
                         const host::Clock& clock, std::function<void(Snapshot)> take,
                         std::function<void()> on_silence)
    : map_(map),
      chosen_(chosen),
      values_(values),
      clock_(clock),
      take_(std::move(take)),
      on_silence_(std::move(on_silence)),
      told_(map.points.size()) {}

/// A look can take several cycles, because a request that ended an earlier connection is put off until the
/// next cycle.
void DeviceLooks::on_cycle() {
  constexpr int longest = 3;
  if (++cycles_ < longest && !is_whole()) return;
  Snapshot now = look(std::nullopt);
  if (!last_.readings.empty()) mark_changes(last_, now);
  last_ = now;
  began_ = clock_.now();
  begin_look();
  has_looked_ = has_chance_ = true;
  take_(std::move(now));
}

/// A point may have been read although its value was not stored, because older changes are still to come:
/// see BitChanges.
bool DeviceLooks::is_from_this_look(const host::ValueTable::Value& value) const {
  return value.number > 0 && (value.stamp.at > began_ || value.quality.last_good > began_);
}

bool DeviceLooks::is_whole() const {
  for (std::uint32_t point = 0; point < map_.points.size(); ++point) {
    if (!chosen_[point] || plan::why_not_read(map_, map_.points[point])) continue;
    const host::ValueTable::Value value = values_.get(point, clock_.now());
    if (!is_from_this_look(value) && !value.quality.is_refused()) return false;
  }
  return true;
}

void DeviceLooks::begin_look() {
  cycles_ = 0;
  told_.assign(told_.size(), false);
}

bool DeviceLooks::is_node() const { return identity_ && *identity_ != host::Identity::Verdict::foreign; }

/// Shows only this change. What the current cycle has read is shown when the cycle ends.
void DeviceLooks::on_told(std::uint32_t point) {
  const auto shown = std::find_if(last_.readings.begin(), last_.readings.end(),
                                  [point](const Reading& reading) { return reading.point == point; });
  if (!has_looked_ || shown == last_.readings.end()) return;
  told_[point] = true;
  Reading now = read(point, std::nullopt);
  if (now.state == shown->state && now.registers == shown->registers) return;
  for (Reading& reading : last_.readings) reading.changed = false;
  *shown = std::move(now);
  shown->changed = true;
  wall_.measure();
  last_.at = std::chrono::system_clock::time_point(
      std::chrono::duration_cast<std::chrono::system_clock::duration>(wall_.of(values_.stamp(point).at)));
  take_(last_);
}

/// A foreign device may always ignore one request. So the first time that a reply is missing before a look
/// has ended, no failure is reported: over the next connection, other requests are sent before that one.
void DeviceLooks::on_failure(const host::Error& error) {
  const bool may_be_a_request = is_no_reply(error) && !is_node() && !has_looked_;
  if (!may_be_a_request || !std::exchange(has_chance_, false)) {
    take_(look(error));
    began_ = clock_.now();
  } else {
    tell_of_silence();
  }
  begin_look();
  identity_.reset();
  notes_.clear();
  has_looked_ = false;
}

void DeviceLooks::tell_of_silence() {
  if (const auto tell = std::exchange(on_silence_, nullptr)) tell();
}

/// If the identity is asked for, and there is none, the first note is that the device does not answer that
/// request.
void DeviceLooks::on_note(host::Level /*level*/, const std::string& text) {
  const bool is_unanswered = map_.verify != Verify::off && !identity_ && !has_looked_ && notes_.empty();
  if (is_unanswered) tell_of_silence();
  if (std::find(notes_.begin(), notes_.end(), text) == notes_.end()) notes_.push_back(text);
}

Snapshot DeviceLooks::look(const std::optional<host::Error>& error) const {
  Snapshot now{std::chrono::system_clock::now(), error, identity_, notes_, {}};
  for (std::uint32_t point = 0; point < map_.points.size(); ++point)
    if (chosen_[point]) now.readings.push_back(read(point, error));
  return now;
}

Reading DeviceLooks::read(std::uint32_t point, const std::optional<host::Error>& error) const {
  Reading reading{point};
  if (const auto reason = plan::why_not_read(map_, map_.points[point])) {
    reading.state = State::not_asked;
    reading.why = plan::words_of(*reason);
    return reading;
  }
  host::ValueTable::Value value = values_.get(point, clock_.now());
  const host::PointQuality& quality = value.quality;
  const bool is_set_aside = !quality.why.empty() && !host::PointQuality::is_unusable(quality.state);
  if (quality.is_refused() || is_set_aside) {
    reading.why = refusal_text(quality, is_node());
    if (quality.why.empty()) reading.exception = quality.last_exception;
  } else if (error ? is_from_this_look(value) && !told_[point] : is_from_this_look(value) || told_[point]) {
    reading.state = state_of(value);
    reading.why = value.why_unusable;
    if (value.has_value()) reading.registers = std::move(value.registers);
  } else {
    reading.why = error ? to_string(*error) : "not asked yet";
  }
  return reading;
}

}  // namespace coupler::tools
