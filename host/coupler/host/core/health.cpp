// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/core/health.hpp"

#include <algorithm>

#include <fmt/format.h>

namespace coupler::host {
namespace {

using State = PointQuality::State;
using Outcome = WriteResult::Outcome;

constexpr std::size_t names_at_most = 5;

/// Returns whether a point's value is missing although it could be read.
bool is_missing(const Point& point, State state) {
  return is_readable(point) && state != State::good && state != State::never_read &&
         state != State::not_wanted;
}

}  // namespace

std::string_view to_string(const std::optional<Identity::Verdict>& verdict) {
  if (!verdict) return "not asked";
  switch (*verdict) {
    case Identity::Verdict::foreign: return "foreign";
    case Identity::Verdict::equal: return "equal";
    case Identity::Verdict::superset: return "superset";
    case Identity::Verdict::different: break;
  }
  return "different";
}

Health connection_health(const DeviceSnapshot& now) {
  if (!now.online)
    return {Level::error, now.trouble.empty() ? "not connected yet" : "offline: " + now.trouble};
  if (now.identity == Identity::Verdict::different)
    return {Level::warning, "online, but the device has another map"};
  return {Level::info, "online"};
}

Health polling_health(const Map& map, const std::vector<PointQuality>& points, const DeviceSnapshot& before,
                      const DeviceSnapshot& now) {
  if (!now.online) return {Level::warning, "nothing is read: the device is offline"};
  std::size_t good = 0;
  std::size_t unusable = 0;
  std::size_t missing = 0;
  std::string names;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (points[i].state == State::good) ++good;
    if (PointQuality::is_unusable(points[i].state)) ++unusable;
    if (!is_missing(map.points[i], points[i].state)) continue;
    if (++missing <= names_at_most)
      names +=
          fmt::format("{}{} ({})", missing > 1 ? ", " : "", map.points[i].name, to_string(points[i].state));
  }
  if (missing > names_at_most) names += fmt::format(" and {} more", missing - names_at_most);
  if (missing > 0) return {good + unusable == 0 ? Level::error : Level::warning, "no value of " + names};
  if (now.overruns > before.overruns)
    return {Level::warning, fmt::format("{} cycles left out; lower the rate, or see below what takes so long",
                                        now.overruns - before.overruns)};
  return {Level::info, fmt::format("{} points good", good)};
}

Health writes_health(const DeviceSnapshot& before, const DeviceSnapshot& now) {
  std::string text;
  for (const Outcome outcome :
       {Outcome::exception, Outcome::not_taken, Outcome::lost, Outcome::dropped, Outcome::refused}) {
    const std::uint64_t count = now.written(outcome) - before.written(outcome);
    if (count > 0) text += fmt::format("{}{} {}", text.empty() ? "" : ", ", count, to_string(outcome));
  }
  if (!text.empty()) return {Level::warning, text};
  return {Level::info, fmt::format("{} written", now.written(Outcome::ok))};
}

Health watchdog_health(const DeviceSnapshot& now) {
  const WatchdogStatus& watchdog = now.watchdog;
  if (watchdog.state == WatchdogStatus::State::fed) return {Level::info, "fed"};
  if (watchdog.error_text.empty()) return {Level::warning, "not fed: the device is offline"};
  return {Level::error, watchdog.error_text};
}

Health certificates_health(const std::optional<Certificates>& certificates,
                           std::chrono::system_clock::time_point at) {
  if (!certificates) return {Level::info, "not connected yet"};
  const Validity& own = certificates->own.validity;
  const Validity& device = certificates->has_pin ? own : certificates->device.validity;
  Health health{Level::info, "good until " + minute_text(std::min(own.end, device.end))};
  const auto look = [&](const char* whose, const Validity& validity) {
    const auto expiry = expiry_text(validity, at);
    if (!expiry) return;
    const std::string before = health.level == Level::info ? "" : health.text + "; ";
    health.text = fmt::format("{}{} certificate {}", before, whose, *expiry);
    health.level = std::max(health.level, at < validity.end ? Level::warning : Level::error);
  };
  look("this machine's", own);
  if (!certificates->has_pin) look("the device's", device);
  return health;
}

}  // namespace coupler::host
