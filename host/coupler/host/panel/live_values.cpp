// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/panel/live_values.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <string_view>
#include <type_traits>
#include <utility>
#include <variant>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "coupler/codec/value.hpp"
#include "coupler/host/core/value_text.hpp"
#include "coupler/host/panel/history_text.hpp"
#include "coupler/host/panel/loop_check.hpp"
#include "coupler/host/record/value_json.hpp"
#include "coupler/json/json_text.hpp"
#include "coupler/map/published.hpp"

namespace coupler::host {
namespace {

using nlohmann::ordered_json;
using Quality = PointQuality::State;

template <class T>
double as_number(const T& value) {
  if constexpr (std::is_arithmetic_v<T>) return static_cast<double>(value);
  return std::nan("");
}

/// NaN: it is no number, or several.
double number_of(const std::uint16_t* registers, const Point& point) {
  if (point.count > 1 || point.format.type == codec::Type::STRING) return std::nan("");
  if (holds_bits(point.table)) return registers[0] != 0 ? 1 : 0;
  if (codec::is_scalable(point.format.type)) return published(registers, point);
  return std::visit([](const auto& value) { return as_number(value); },
                    codec::decode(registers, point.format));
}

}  // namespace

LiveValues::LiveValues(const Map& map, const ValueTable& table, Report report)
    : map_(map), table_(table), report_(std::move(report)), points_(map.points.size()) {
  for (std::size_t i = 0; i < points_.size(); ++i)
    if (const unsigned bits = bits_of(map.points[i]); bits > 0)
      points_[i].bits = std::make_unique<WordBits>(bits);
}

void LiveValues::take_number(std::uint32_t i, Time at) {
  const Point& point = map_.points[i];
  const Span<const std::uint16_t> registers(table_.registers(i), range(point).count());
  State& state = points_[i];
  state.history.take(number_of(registers.data(), point), at);
  if (state.bits)
    state.bits->take(std::get<std::uint64_t>(codec::decode(registers.data(), point.format)), at);
  const bool is_off =
      std::all_of(registers.begin(), registers.end(), [](std::uint16_t each) { return each == 0; });
  (is_off ? state.seen_off : state.seen_on) = true;
}

void LiveValues::on_values(Span<const std::uint32_t> points) {
  const std::lock_guard lock(mutex_);
  bool any = false;
  for (const std::uint32_t i : points) {
    State& state = points_[i];
    const std::uint64_t number = table_.number(i);
    const bool is_new = std::exchange(state.number, number) != number;
    if (!is_new && state.quality == Quality::good) continue;
    const Time at = table_.stamp(i).at;
    if (is_new) state.changed_at = at;
    if (std::exchange(state.quality, Quality::good) != Quality::good)
      stale_from_ = std::min(stale_from_, table_.quality(i, at).stale_from);
    take_number(i, at);
    state.revision = ++revision_;
    any = true;
  }
  if (any) news_.notify_all();
}

void LiveValues::on_no_values(Span<const std::uint32_t> points, Time at) {
  const std::lock_guard lock(mutex_);
  bool any = false;
  for (const std::uint32_t i : points) {
    State& state = points_[i];
    const std::uint64_t number = table_.number(i);
    const bool is_known = state.quality == table_.last_read(i) && state.unusable_number == number;
    if (!table_.is_usable(i) && is_known && table_.state_when_online(i, at) == state.quality) continue;
    any |= take_quality(i, table_.quality(i, at), at);
    state.unusable_number = number;
  }
  if (any) news_.notify_all();
}

void LiveValues::on_online(bool online) {
  {
    const std::lock_guard lock(mutex_);
    online_ = online;
    device_revision_ = ++revision_;
    const Time now = std::chrono::steady_clock::now();
    if (online) {
      why_offline_.clear();
      take_qualities(now);
    } else {
      for (State& state : points_) {
        if (state.quality != Quality::never_read) state.quality = Quality::offline;
        state.lose(now);
        state.revision = revision_;
      }
    }
  }
  news_.notify_all();
}

void LiveValues::on_loss(const std::string& why) {
  {
    const std::lock_guard lock(mutex_);
    why_offline_ = why;
    device_revision_ = ++revision_;
  }
  news_.notify_all();
}

/// Notes that a point is refused, unusable or stale. Returns whether that is news for the pages. All other
/// qualities follow from new values and from the state of the connection.
bool LiveValues::take_quality(std::uint32_t i, const PointQuality& now, Time at) {
  if (!now.is_refused() && !PointQuality::is_unusable(now.state) && now.state != Quality::stale) return false;
  const unsigned code = now.is_refused() ? now.refused_with() : 0;
  State& state = points_[i];
  if (state.quality == now.state && state.exception == code && state.why == now.why) return false;
  state.quality = now.state;
  state.exception = code;
  state.why = now.why;
  state.lose(at);
  state.revision = ++revision_;
  return true;
}

/// Finds the points that have become stale, and those that were refused before the device was online.
void LiveValues::take_qualities(Time now) {
  const std::vector<PointQuality> qualities = table_.qualities(now);
  stale_from_ = Time::max();
  for (std::uint32_t i = 0; i < points_.size(); ++i) {
    take_quality(i, qualities[i], now);
    stale_from_ = std::min(stale_from_, qualities[i].stale_from);
  }
}

void LiveValues::stopped() { on_online(false); }

void LiveValues::end() {
  {
    const std::lock_guard lock(mutex_);
    ended_ = true;
  }
  news_.notify_all();
}

void LiveValues::tell(const DeviceSnapshot& device) {
  const std::uint64_t refused =
      std::accumulate(device.exceptions.begin(), device.exceptions.end(), std::uint64_t{0});
  {
    const std::lock_guard lock(mutex_);
    requests_ = device.requests;
    errors_ = device.timeouts + device.failures + refused;
    round_trip_ = device.latency.quantile(0.5);
    device_revision_ = ++revision_;
    take_qualities(std::chrono::steady_clock::now());
  }
  news_.notify_all();
}

std::string LiveValues::news(std::uint64_t& seen, Time earliest, Time until) {
  std::unique_lock lock(mutex_);
  news_.wait_until(lock, earliest, [&] { return ended_; });
  Time now = std::chrono::steady_clock::now();
  while (true) {
    if (now > stale_from_) take_qualities(now);
    if (ended_ || revision_ > seen || now >= until) break;
    news_.wait_until(lock, std::min(until, stale_from_));
    now = std::chrono::steady_clock::now();
  }
  ordered_json points = ordered_json::object();
  for (std::size_t i = 0; i < points_.size(); ++i) {
    const State& state = points_[i];
    if (state.revision <= seen) continue;
    const Point& point = map_.points[i];
    ordered_json json{{"quality", to_string(state.quality)},
                      {"changes", changes_of(state)},
                      {"on", state.seen_on},
                      {"off", state.seen_off}};
    if (state.bits) json["bits"] = state.bits->json();
    const ValueTable::Value value = table_.get(static_cast<std::uint32_t>(i), now);
    if (state.number > 0 && value.has_value()) {
      json["value"] = value_json(value.registers.data(), point);
      json["text"] = format_value(value.registers.data(), point);
      json["age"] = std::chrono::duration<double>(now - state.changed_at).count();
    }
    const bool is_refused = PointQuality::is_refused(state.quality);
    if (is_refused && state.exception != 0) json["exception"] = state.exception;
    if ((is_refused || PointQuality::is_unusable(state.quality)) && !state.why.empty())
      json["why"] = state.why;
    points[std::string(point.name)] = std::move(json);
  }
  ordered_json json{{"revision", revision_}, {"points", std::move(points)}};
  if (device_revision_ > seen)
    json["device"] = {{"online", online_},
                      {"why", why_offline_},
                      {"requests", requests_},
                      {"errors", errors_},
                      {"round_trip_ms", std::chrono::duration<double, std::milli>(round_trip_).count()}};
  seen = revision_;
  lock.unlock();
  return json_text(json);
}

std::string LiveValues::histories(Time now, std::size_t steps) {
  const std::size_t first = History::steps - std::min(steps, History::steps);
  std::string all = "{";
  for (std::size_t i = 0; i < points_.size(); ++i) {
    std::optional<StepHistory<BitsStep>> bits;
    // One at a time: the connection's thread waits for the lock.
    const History history = [&] {
      const std::lock_guard lock(mutex_);
      State& state = points_[i];
      state.history.advance(now);
      if (state.bits) {
        state.bits->advance(now);
        bits = state.bits->history();
      }
      return state.history;
    }();
    const std::string_view name = map_.points[i].name;
    all += fmt::format("{}\"{}\":{}", i > 0 ? "," : "", name, steps_text(history, first));
    if (bits) all += fmt::format(",\"{}.bits\":{}", name, steps_text(*bits, first));
  }
  return all + '}';
}

std::string LiveValues::seen_csv() {
  const std::lock_guard lock(mutex_);
  std::string text = loop_check_head();
  for (std::size_t i = 0; i < points_.size(); ++i) {
    const State& state = points_[i];
    text += loop_check_lines(map_.points[i], {state.seen_off, state.seen_on, changes_of(state)},
                             state.bits.get());
  }
  return text;
}

}  // namespace coupler::host
