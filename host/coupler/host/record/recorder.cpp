// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/record/recorder.hpp"

#include <algorithm>
#include <chrono>
#include <utility>

#include <fmt/format.h>

#include "coupler/map/fingerprint.hpp"
#include "coupler/map/loader/without_keys.hpp"
#include "coupler/plan/explain.hpp"
#include "coupler/plan/planner.hpp"

namespace coupler::host {
namespace {

using record::Moment;
using record::Nanoseconds;
using State = PointQuality::State;

record::Head head_of(const Map& map, std::string device) {
  record::Head head{std::string(map.name), std::move(device), fingerprint_text(map.fingerprint),
                    without_keys(map.text, {"security", "tls"})};
  for (const Point& point : map.points) {
    const double rate = point.host.rate > 0 ? point.host.rate : map.polling.rate;
    const double period = 1 / rate;
    if (const auto reason = plan::why_not_read(map, point)) {
      head.not_recorded.emplace_back(point.name, plan::words_of(*reason));
      continue;
    }
    head.periods.emplace_back(point.name, period);
    if (const auto pulse = std::chrono::duration<double>(point.pulse).count();
        pulse > 0 && pulse < 2 * period)
      head.may_miss.emplace_back(point.name, fmt::format("pulses of {} ms, read every {:.0f} ms",
                                                         point.pulse.count(), 1000 * period));
  }
  return head;
}

}  // namespace

Recorder::Recorder(const Map& map, const ValueTable& values, std::string device, const RecordFormat& format,
                   Time start, Report report)
    : map_(map),
      values_(values),
      format_(format),
      start_(start),
      report_(std::move(report)),
      head_(head_of(map, std::move(device))),
      lines_(map.points.size()) {
  wall_.measure();
}

Moment Recorder::moment(Time at) const {
  return {std::max(Nanoseconds(at - start_), Nanoseconds(0)), wall_.of(at)};
}

void Recorder::queue(const std::string& line) {
  if (queued_.size() + line.size() > longest_queue)
    lost_ = true;
  else
    queued_ += line;
}

void Recorder::on_values(Span<const std::uint32_t> points) {
  const std::lock_guard lock(mutex_);
  for (const std::uint32_t i : points) {
    Line& line = lines_[i];
    const auto before = std::exchange(line.quality, State::good);
    const std::uint64_t number = values_.number(i);
    const bool is_new = std::exchange(line.number, number) != number;
    if (before == State::good && !is_new) continue;
    ++counts_.changes;
    const Stamp stamp = values_.stamp(i);
    const Point& point = map_.points[i];
    queue(format_.value(moment(stamp.at), point, {values_.registers(i), range(point).count()},
                        stamp.uncertainty, State::good));
  }
}

void Recorder::on_no_values(Span<const std::uint32_t> points, Time at) {
  const std::lock_guard lock(mutex_);
  for (const std::uint32_t i : points)
    if (PointQuality::is_unusable(values_.state_when_online(i, at)))
      queue_unusable(i);
    else if (online_)
      queue_exception(i, at);
}

void Recorder::queue_unusable(std::uint32_t i) {
  Line& line = lines_[i];
  const std::uint64_t number = values_.number(i);
  const State quality = values_.last_read(i);
  if (line.quality == quality && line.number == number) return;
  line = {quality, 0, number};
  ++counts_.changes;
  const Stamp stamp = values_.stamp(i);
  const Point& point = map_.points[i];
  queue(format_.value(moment(stamp.at), point, {values_.registers(i), range(point).count()},
                      stamp.uncertainty, quality));
}

void Recorder::queue_exception(std::uint32_t i, Time at) {
  const PointQuality now = values_.quality(i, at);
  Line& line = lines_[i];
  if (!now.is_refused() || (line.quality == now.state && line.exception == now.refused_with())) return;
  line = {now.state, now.refused_with()};
  ++counts_.changes;
  queue(format_.no_value(moment(at), map_.points[i], line.quality, line.exception));
}

void Recorder::on_identified(Identity::Verdict verdict) {
  const std::lock_guard lock(mutex_);
  is_node_ = verdict != Identity::Verdict::foreign;
}

void Recorder::on_online(bool online) {
  const std::lock_guard lock(mutex_);
  if (ends_) return;
  online_ = counts_.online = online;
  counts_.was_online |= online;
  awaits_reason_ = !online;
  if (!online) {  // the values may have changed since: each is recorded again
    for (Line& line : lines_) line.quality = State::offline;
    return;
  }
  why_offline_.clear();
  const Time now = std::chrono::steady_clock::now();
  queue(device_line(moment(now)));
  for (std::uint32_t i = 0; i < lines_.size(); ++i) queue_exception(i, now);
}

/// The reasons for which the next attempts fail are not lines of their own.
void Recorder::on_loss(const std::string& why) {
  const std::lock_guard lock(mutex_);
  if (ends_ || !std::exchange(awaits_reason_, false)) return;
  why_offline_ = why;
  queue(device_line(moment(std::chrono::steady_clock::now())));
}

void Recorder::end_comes() {
  const std::lock_guard lock(mutex_);
  ends_ = true;
}

/// The value in the table may be newer than the last line of the point, because the device stores a value
/// before it calls on_values().
std::string Recorder::line_of(std::uint32_t i, Time now) {
  const Point& point = map_.points[i];
  Line& line = lines_[i];
  if (line.quality == State::offline || line.quality == State::never_read) return {};
  if (line.quality != State::good && !PointQuality::is_unusable(line.quality))
    return format_.no_value(moment(now), point, line.quality, line.exception);
  const ValueTable::Value value = values_.get(i, now);
  line.number = value.number;
  line.quality = value.read_as;
  return format_.value(moment(std::max(now, value.stamp.at)), point,
                       {value.registers.data(), range(point).count()}, value.stamp.uncertainty,
                       value.read_as);
}

std::string Recorder::device_line(Moment at) const {
  return online_ ? format_.online(at, is_node_) : format_.lost(at, why_offline_);
}

Recorder::Taken Recorder::take(Time now) {
  const std::lock_guard lock(mutex_);
  return take_now(now);
}

Recorder::Taken Recorder::take_now(Time now) {
  if (const Nanoseconds set_by = wall_.measure(); set_by != set_by.zero())
    queue(format_.clock(moment(now), set_by));
  Taken taken{std::move(queued_), std::exchange(lost_, false)};
  queued_.clear();
  return taken;
}

std::string Recorder::beginning(Time now) {
  const std::lock_guard lock(mutex_);
  return format_.head(head_, moment(now)) + all_lines(now);
}

Recorder::Turn Recorder::turn(Time now) {
  const std::lock_guard lock(mutex_);
  Taken before = take_now(now);
  return {std::move(before), format_.head(head_, moment(now)) + all_lines(now)};
}

std::string Recorder::all_values(Time now) {
  const std::lock_guard lock(mutex_);
  return all_lines(now);
}

std::string Recorder::all_lines(Time now) {
  std::string text = device_line(moment(now));
  for (std::uint32_t i = 0; i < lines_.size(); ++i) text += line_of(i, now);
  return text;
}

std::string Recorder::missing(Time now, Time since, std::string_view why) {
  const std::lock_guard lock(mutex_);
  return format_.missing(moment(now), since - start_, why);
}

std::string Recorder::end(Time now) {
  const std::lock_guard lock(mutex_);
  return format_.end(moment(now));
}

Recorder::Counts Recorder::counts() const {
  const std::lock_guard lock(mutex_);
  Counts counts = counts_;
  counts.good = static_cast<std::size_t>(std::count_if(
      lines_.begin(), lines_.end(), [](const Line& line) { return line.quality == State::good; }));
  return counts;
}

}  // namespace coupler::host
