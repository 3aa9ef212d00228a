// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/core/pace.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "coupler/plan/planner.hpp"

namespace coupler::host {
namespace {

constexpr std::chrono::seconds window(10);
constexpr double kept_at_least = 0.8;  ///< of the cycles; with less it is too slow
constexpr double kept_up = 0.95;       ///< with this much it keeps up
constexpr int windows_until_forgotten = 6;

/// 6.4 a second is "6"; less than 2 has a decimal.
double rounded_down(double rate) {
  return rate >= 2 ? std::floor(rate) : std::max(0.1, std::floor(rate * 10) / 10);
}

/// 477 is 480.
double two_digits(double rate) {
  const double step = std::pow(10, std::floor(std::log10(rate)) - 1);
  return std::round(rate / step) * step;
}

/// The rates of a map: whether there is one only, and the fastest.
struct Rates {
  double fastest = 0;
  bool is_one = true;
};

Rates rates_of(const Map& map) {
  Rates rates;
  for (const Point& point : map.points) {
    if (plan::why_not_read(map, point)) continue;
    const double rate = plan::rate_of(map, point);
    rates.is_one &= rates.fastest == 0 || rates.fastest == rate;
    rates.fastest = std::max(rates.fastest, rate);
  }
  return rates;
}

std::string too_slow(const Map& map, double share) {
  const Rates rates = rates_of(map);
  const double possible = rounded_down(rates.fastest * share);
  if (rates.is_one)
    return fmt::format(
        "the device is too slow for 'rate: {:g}', or this computer is busy: its points are read about {:g} "
        "times a second; set 'rate: {:g}' in the map, or --rate. `coupler plan` says what takes how long",
        rates.fastest, two_digits(rates.fastest * share), possible);
  return fmt::format(
      "the device is too slow for the rates of the map, or this computer is busy: {:.0f} % of the cycles are "
      "done. Set lower rates; the fastest may be {:g} if the others are lowered, too. `coupler plan` says "
      "what takes how long",
      100 * share, possible);
}

}  // namespace

void Pace::begin(const Counts& counts, Time at) {
  at_begin_ = counts;
  begun_ = at;
}

std::optional<std::string> Pace::update(const Map& map, const DeviceSnapshot& now, Time at) {
  const Counts counts{now.cycles.count(), now.overruns};
  if (!now.online) begun_.reset();
  if (!now.online || (begun_ && at - *begun_ < window)) return std::nullopt;
  const auto before = begun_ ? std::optional(at_begin_) : std::nullopt;
  begin(counts, at);
  if (!before) return std::nullopt;
  const auto done = static_cast<double>(counts.done - before->done);
  const auto left_out = static_cast<double>(counts.left_out - before->left_out);
  if (done == 0) return std::nullopt;  // nothing is polled
  const double share = done / (done + left_out);
  windows_kept_up_ = share >= kept_up ? windows_kept_up_ + 1 : 0;
  if (windows_kept_up_ >= windows_until_forgotten) trouble_.clear();
  if (share >= kept_at_least || !trouble_.empty()) return std::nullopt;
  trouble_ = too_slow(map, share);
  return trouble_;
}

}  // namespace coupler::host
