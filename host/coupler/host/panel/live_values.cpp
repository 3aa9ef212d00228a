// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/panel/live_values.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <type_traits>
#include <utility>
#include <variant>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "coupler/codec/scale.hpp"
#include "coupler/codec/value.hpp"
#include "coupler/host/core/own_registers.hpp"
#include "coupler/host/core/value_text.hpp"
#include "coupler/host/record/value_json.hpp"
#include "coupler/json/json_text.hpp"

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
  if (codec::is_scalable(point.format.type)) return codec::published(registers, point.format, point.scale);
  return std::visit([](const auto& value) { return as_number(value); },
                    codec::decode(registers, point.format));
}

}  // namespace

LiveValues::LiveValues(const Map& map, Report report)
    : map_(map), report_(std::move(report)), points_(map.points.size()) {}

void LiveValues::take_number(const Point& point, State& state, Time at) {
  state.history.take(number_of(state.registers.data(), point), at);
  const bool is_off = std::all_of(state.registers.begin(), state.registers.end(),
                                  [](std::uint16_t each) { return each == 0; });
  (is_off ? state.seen_off : state.seen_on) = true;
}

template <class Element>
void LiveValues::take(const ReadSpan& span, Span<const Element> values, Stamp stamp) {
  const std::lock_guard lock(mutex_);
  bool any = false;
  for (const std::uint32_t i : span.points) {
    const Point& point = map_.points[i];
    take_own(span, values, point, next_);
    State& state = points_[i];
    const bool is_same = state.registers == next_;
    if (is_same && state.quality == Quality::good) continue;
    if (!is_same) {
      if (!state.registers.empty()) ++state.changes;
      std::swap(state.registers, next_);
      state.changed_at = stamp.at;
    }
    state.quality = Quality::good;
    take_number(point, state, stamp.at);
    state.revision = ++revision_;
    any = true;
  }
  if (any) news_.notify_all();
}

void LiveValues::on_bits(const ReadSpan& span, Span<const std::uint8_t> bits, Stamp stamp) {
  take(span, bits, stamp);
}

void LiveValues::on_registers(const ReadSpan& span, Span<const std::uint16_t> registers, Stamp stamp) {
  take(span, registers, stamp);
}

void LiveValues::on_online(bool online) {
  {
    const std::lock_guard lock(mutex_);
    online_ = online;
    device_revision_ = ++revision_;
    if (online) why_offline_.clear();
    const Time now = std::chrono::steady_clock::now();
    if (!online)
      for (State& state : points_) {
        if (state.quality != Quality::never_read) state.quality = Quality::offline;
        state.history.lose(now);
        state.revision = revision_;
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

void LiveValues::judge(const std::vector<PointQuality>& qualities, Time now) {
  bool any = false;
  {
    const std::lock_guard lock(mutex_);
    if (!online_) return;  // these qualities may be from before
    for (std::size_t i = 0; i < points_.size(); ++i) {
      const Quality quality = qualities[i].state;
      // All else comes with values and the connection.
      const bool is_refused = quality == Quality::exception || quality == Quality::rejected;
      if (!is_refused && quality != Quality::stale) continue;
      const unsigned code = is_refused ? qualities[i].refused_with() : 0;
      State& state = points_[i];
      if (state.quality == quality && state.exception == code && state.why == qualities[i].why) continue;
      state.quality = quality;
      state.exception = code;
      state.why = qualities[i].why;
      state.history.lose(now);
      state.revision = ++revision_;
      any = true;
    }
  }
  if (any) news_.notify_all();
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
  }
  news_.notify_all();
}

std::string LiveValues::news(std::uint64_t& seen, Time earliest, Time until) {
  std::unique_lock lock(mutex_);
  news_.wait_until(lock, earliest, [&] { return ended_; });
  news_.wait_until(lock, until, [&] { return ended_ || revision_ > seen; });
  const Time now = std::chrono::steady_clock::now();
  ordered_json points = ordered_json::object();
  for (std::size_t i = 0; i < points_.size(); ++i) {
    const State& state = points_[i];
    if (state.revision <= seen) continue;
    const Point& point = map_.points[i];
    ordered_json json{{"quality", to_string(state.quality)},
                      {"changes", state.changes},
                      {"on", state.seen_on},
                      {"off", state.seen_off}};
    if (!state.registers.empty()) {
      json["value"] = value_json(state.registers.data(), point);
      json["text"] = format_value(state.registers.data(), point);
      json["age"] = std::chrono::duration<double>(now - state.changed_at).count();
    }
    const bool is_refused = state.quality == Quality::exception || state.quality == Quality::rejected;
    if (is_refused && state.exception != 0) json["exception"] = state.exception;
    if (is_refused && !state.why.empty()) json["why"] = state.why;
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
  std::string all = "{";
  for (std::size_t i = 0; i < points_.size(); ++i) {
    // One at a time: the connection's thread waits for the lock.
    const History history = [&] {
      const std::lock_guard lock(mutex_);
      points_[i].history.advance(now);
      return points_[i].history;
    }();
    all += fmt::format("{}\"{}\":[", i > 0 ? "," : "", map_.points[i].name);
    const std::size_t first = History::steps - std::min(steps, History::steps);
    for (std::size_t j = first; j < History::steps; ++j) {
      const History::Step& step = history.at(j);
      if (j > first) all += ',';
      all += std::isfinite(step.least) ? fmt::format("[{},{}]", step.least, step.greatest) : "null";
    }
    all += ']';
  }
  return all + '}';
}

std::string LiveValues::seen_csv() {
  const std::lock_guard lock(mutex_);
  std::string text = "point,seen_off,seen_on,changes\r\n";
  for (std::size_t i = 0; i < points_.size(); ++i)
    text += fmt::format("{},{},{},{}\r\n", map_.points[i].name, points_[i].seen_off ? "yes" : "no",
                        points_[i].seen_on ? "yes" : "no", points_[i].changes);
  return text;
}

}  // namespace coupler::host
