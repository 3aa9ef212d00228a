// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/core/publish_policy.hpp"

#include <algorithm>
#include <cmath>

#include "coupler/codec/value.hpp"
#include "coupler/map/published.hpp"

namespace coupler::host {
namespace {

using Publish = HostOptions::Publish;

/// NaN where it is not a number. The types of numbers cost no allocation.
double number(const std::uint16_t* registers, const codec::Format& format) {
  return std::visit(
      [](const auto& value) -> double {
        using T = std::decay_t<decltype(value)>;
        if constexpr (std::is_same_v<T, bool> || std::is_same_v<T, std::string>)
          return std::nan("");
        else
          return static_cast<double>(value);
      },
      codec::decode(registers, format));
}

bool is_number(codec::Type type) { return type != codec::Type::BOOL && type != codec::Type::STRING; }

}  // namespace

PublishPolicy::PublishPolicy(const Point& point)
    : point_(point), last_(point.host.publish == Publish::on_change ? host_registers(point) : 0) {}

Time PublishPolicy::repeat_at() const {
  const HostOptions& host = point_.host;
  const bool repeats = host.publish == Publish::on_change && host.max_interval.count() > 0;
  return repeats ? last_at_ + host.max_interval : Time::max();
}

bool PublishPolicy::calls_news(const std::uint16_t* registers, Time at) {
  const HostOptions& host = point_.host;
  if (host.publish == Publish::always) return true;
  const bool in_time = at < repeat_at();
  if (!renewed_.exchange(false) && in_time && !differs(registers)) return false;
  std::copy_n(registers, last_.size(), last_.begin());
  last_at_ = at;
  return true;
}

bool PublishPolicy::differs(const std::uint16_t* registers) const {
  const auto mask = holds_bits(point_.table) ? std::uint16_t{1} : codec::mask(point_.format);
  const auto same = [mask](std::uint16_t a, std::uint16_t b) { return ((a ^ b) & mask) == 0; };
  const double gain_before = scale_of(last_.data(), point_).gain;
  const double gain = scale_of(registers, point_).gain;
  const std::size_t own = range(point_).count();
  if (gain == gain_before && std::equal(last_.data(), last_.data() + own, registers, same)) return false;
  if (point_.host.deadband <= 0 || !is_number(point_.format.type)) return true;
  const std::size_t width = codec::registers(point_.format);
  for (std::size_t at = 0; at < own; at += width) {
    const double before = number(&last_[at], point_.format);
    const double now = number(registers + at, point_.format);
    if (std::isnan(before) != std::isnan(now)) return true;
    const double change = gain == gain_before ? (now - before) * gain : now * gain - before * gain_before;
    if (std::fabs(change) > point_.host.deadband) return true;
  }
  return false;
}

}  // namespace coupler::host
