// SPDX-License-Identifier: Apache-2.0
#include "coupler/device/replay/differences.hpp"

#include <algorithm>
#include <cmath>
#include <utility>
#include <variant>

#include <fmt/format.h>

#include "coupler/codec/scale.hpp"
#include "coupler/codec/value.hpp"

namespace coupler::device {
namespace {

constexpr Nanoseconds unknown_period{std::chrono::milliseconds(100)};

std::string text_of(const std::uint16_t* registers, const Point& point) {
  if (holds_bits(point.table)) return registers[0] != 0 ? "true" : "false";
  if (point.scale.present())
    return fmt::format("{:.15g}", codec::published(registers, point.format, point.scale));
  return std::visit([](const auto& value) { return fmt::format("{}", value); },
                    codec::decode(registers, point.format));
}

/// Registers of one value.
std::uint16_t width_of(const Point& point) {
  return holds_bits(point.table) ? std::uint16_t{1} : codec::registers(point.format);
}

std::string text_of(const std::vector<std::uint16_t>& registers, const Point& point) {
  std::string text;
  for (std::size_t i = 0; i < registers.size(); i += width_of(point))
    text += (i == 0 ? "" : " ") + text_of(&registers[i], point);
  return text;
}

}  // namespace

Differences::Differences(const Recording& recording, Nanoseconds tolerance, const std::vector<bool>& wanted)
    : recording_(recording), tolerance_(tolerance), outputs_(recording.map()->map().points.size()) {
  for (std::uint32_t i = 0; i < outputs_.size(); ++i) outputs_[i].is_wanted = wanted[i];
}

Nanoseconds Differences::tolerance(std::uint32_t point) const {
  if (tolerance_.count() > 0) return tolerance_;
  const Nanoseconds period = recording_.period(point);
  return 2 * (period.count() > 0 ? period : unknown_period);
}

/// Numbers within the point's deadband; all else bit by bit.
bool Differences::are_equal(std::uint32_t index, const Registers& a, const Registers& b) const {
  if (a == b || a.size() != b.size()) return a == b;
  const Point& point = recording_.map()->map().points[index];
  if (holds_bits(point.table) || point.host.deadband <= 0 || !codec::is_scalable(point.format.type))
    return false;
  const auto number = [&](const std::uint16_t* registers) {
    return codec::published(registers, point.format, point.scale);
  };
  for (std::size_t i = 0; i < a.size(); i += width_of(point))
    if (!(std::abs(number(&a[i]) - number(&b[i])) <= point.host.deadband)) return false;
  return true;
}

void Differences::change(std::uint32_t point, Change change, std::deque<Change>& own,
                         std::deque<Change>& others) {
  const Nanoseconds most = tolerance(point);
  const auto partner = std::find_if(others.begin(), others.end(), [&](const Change& other) {
    return std::chrono::abs(change.at - other.at) <= most &&
           are_equal(point, change.registers, other.registers);
  });
  if (partner == others.end())
    own.push_back(std::move(change));
  else
    others.erase(partner);
}

void Differences::recorded(std::uint32_t point, const std::uint16_t* registers, Nanoseconds at) {
  Output& output = outputs_[point];
  Registers now(registers, registers + range(recording_.map()->map().points[point]).count());
  if (now == output.recorded) return;
  // The values before anybody wrote, and those at the beginning of the recording, are no differences.
  const bool is_before = !output.is_written || output.recorded.empty();
  output.has_changed |= !output.recorded.empty();
  output.recorded = now;
  change(point, {at, std::move(now), is_before}, output.recorded_alone, output.written_alone);
  if (output.is_written) return;
  const Nanoseconds most = tolerance(point);
  while (!output.recorded_alone.empty() && at - output.recorded_alone.front().at > most)
    output.recorded_alone.pop_front();
}

void Differences::written(std::uint32_t point, const std::uint16_t* registers, Nanoseconds at) {
  Output& output = outputs_[point];
  Registers now(registers, registers + range(recording_.map()->map().points[point]).count());
  const bool is_first = !std::exchange(output.is_written, true);
  if (is_first) {
    output.written = now;
    const Nanoseconds most = tolerance(point);
    while (!output.recorded_alone.empty() && at - output.recorded_alone.front().at > most)
      output.recorded_alone.pop_front();
    if (are_equal(point, now, output.recorded)) {
      output.recorded_alone.clear();  // it has just come, and is what was written
      return;
    }
  } else {
    if (now == output.written) return;
    output.written = now;
  }
  change(point, {at, std::move(now), false}, output.written_alone, output.recorded_alone);
}

Nanoseconds Differences::open_until() const {
  Nanoseconds until{};
  for (std::uint32_t i = 0; i < outputs_.size(); ++i) {
    const Output& output = outputs_[i];
    if (!output.is_wanted || !output.is_written) continue;
    for (const std::deque<Change>* alone : {&output.recorded_alone, &output.written_alone})
      if (!alone->empty()) until = std::max(until, alone->back().at + tolerance(i));
  }
  return until;
}

std::vector<std::uint32_t> Differences::unwritten() const {
  std::vector<std::uint32_t> points;
  for (std::uint32_t i = 0; i < outputs_.size(); ++i)
    if (outputs_[i].is_wanted && outputs_[i].has_changed && !outputs_[i].is_written) points.push_back(i);
  return points;
}

std::vector<Differences::Difference> Differences::take(Nanoseconds now) { return take_before(now); }

std::vector<Differences::Difference> Differences::take_all() { return take_before(Nanoseconds::max()); }

void Differences::begin_again() {
  for (Output& output : outputs_) output.recorded.clear();
}

std::vector<Differences::Difference> Differences::take_before(Nanoseconds now) {
  std::vector<Difference> found;
  for (std::uint32_t i = 0; i < outputs_.size(); ++i) {
    Output& output = outputs_[i];
    if (!output.is_written) continue;
    const Point& point = recording_.map()->map().points[i];
    const Nanoseconds most = tolerance(i);
    const auto take_from = [&](std::deque<Change>& alone, const char* what) {
      if (!output.is_wanted) return alone.clear();
      while (!alone.empty() && (now == Nanoseconds::max() || now - alone.front().at > most)) {
        const Change& change = alone.front();
        if (!change.is_before && !output.recorded.empty())
          found.push_back({change.at, i, fmt::format("{} {}", what, text_of(change.registers, point))});
        alone.pop_front();
      }
    };
    take_from(output.recorded_alone, "nobody wrote the recorded");
    take_from(output.written_alone, "the recording does not have the written");
  }
  std::stable_sort(found.begin(), found.end(),
                   [](const Difference& a, const Difference& b) { return a.at < b.at; });
  return found;
}

}  // namespace coupler::device
