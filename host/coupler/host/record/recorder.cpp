// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/record/recorder.hpp"

#include <algorithm>
#include <chrono>
#include <utility>

#include <fmt/format.h>

#include "coupler/host/core/own_registers.hpp"
#include "coupler/map/fingerprint.hpp"
#include "coupler/map/loader/without_keys.hpp"
#include "coupler/plan/explain.hpp"
#include "coupler/plan/planner.hpp"

namespace coupler::host {
namespace {

using record::Moment;
using record::Nanoseconds;

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

Recorder::Recorder(const Map& map, std::string device, const RecordFormat& format, Time start, Report report)
    : map_(map),
      format_(format),
      start_(start),
      report_(std::move(report)),
      head_(head_of(map, std::move(device))),
      points_(map.points.size()) {
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

template <class Element>
void Recorder::take_values(const ReadSpan& span, Span<const Element> values, Stamp stamp) {
  const std::lock_guard lock(mutex_);
  for (const std::uint32_t i : span.points) {
    take_own(span, values, map_.points[i], next_);
    State& state = points_[i];
    state.read_at = stamp.at;
    if (state.quality == PointQuality::State::good && state.registers == next_) continue;
    std::swap(state.registers, next_);
    state.quality = PointQuality::State::good;
    state.uncertainty = stamp.uncertainty;
    ++counts_.changes;
    queue(line_of(i, moment(stamp.at)));
  }
}

void Recorder::on_bits(const ReadSpan& span, Span<const std::uint8_t> bits, Stamp stamp) {
  take_values(span, bits, stamp);
}

void Recorder::on_registers(const ReadSpan& span, Span<const std::uint16_t> registers, Stamp stamp) {
  take_values(span, registers, stamp);
}

void Recorder::on_identified(bool is_node) {
  const std::lock_guard lock(mutex_);
  is_node_ = is_node;
}

void Recorder::on_online(bool online) {
  const std::lock_guard lock(mutex_);
  if (ends_) return;
  online_ = counts_.online = online;
  counts_.was_online |= online;
  awaits_reason_ = !online;
  if (online)
    why_offline_.clear();
  else  // what was true before may not be any more: each value is recorded again
    for (State& state : points_) state.quality = PointQuality::State::offline;
  if (online) queue(device_line(moment(std::chrono::steady_clock::now())));
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

void Recorder::judge(const std::vector<PointQuality>& qualities, Time now) {
  using Quality = PointQuality::State;
  const std::lock_guard lock(mutex_);
  for (std::uint32_t i = 0; i < points_.size(); ++i) {
    const Quality quality = qualities[i].state;
    if (quality != Quality::exception && quality != Quality::rejected) continue;
    const unsigned code = qualities[i].refused_with();
    State& state = points_[i];
    const bool is_newer = state.read_at > now;  // it has been read since
    if (!online_ || is_newer || (state.quality == quality && state.exception == code)) continue;
    state.quality = quality;
    state.exception = code;
    ++counts_.changes;
    queue(line_of(i, moment(now)));
  }
}

std::string Recorder::line_of(std::uint32_t i, Moment at) const {
  using Quality = PointQuality::State;
  const Point& point = map_.points[i];
  const State& state = points_[i];
  if (state.quality == Quality::exception || state.quality == Quality::rejected)
    return format_.no_value(at, point, state.quality, state.exception);
  if (state.quality != Quality::good) return {};
  return format_.value(at, point, {state.registers.data(), state.registers.size()}, state.uncertainty);
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
  const Moment at = moment(now);
  return format_.head(head_, at) + all_values(at);
}

Recorder::Turn Recorder::turn(Time now) {
  const std::lock_guard lock(mutex_);
  Taken before = take_now(now);
  const Moment at = moment(now);
  return {std::move(before), format_.head(head_, at) + all_values(at)};
}

std::string Recorder::all_values(Time now) {
  const std::lock_guard lock(mutex_);
  return all_values(moment(now));
}

std::string Recorder::all_values(Moment at) const {
  std::string text = device_line(at);
  for (std::uint32_t i = 0; i < points_.size(); ++i) text += line_of(i, at);
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
  counts.good =
      static_cast<std::size_t>(std::count_if(points_.begin(), points_.end(), [](const State& state) {
        return state.quality == PointQuality::State::good;
      }));
  return counts;
}

}  // namespace coupler::host
