// SPDX-License-Identifier: Apache-2.0
#include "coupler/device/node/point_hooks.hpp"

#include <unistd.h>

#include <algorithm>
#include <mutex>
#include <utility>

namespace coupler::device {
namespace {

constexpr std::size_t most_values = 16;

/// How many changes of bits nobody hears of if the last of the values, `count` bits each, is left out.
std::uint32_t changes_lost(const std::vector<std::uint16_t>& values, const std::uint16_t* next,
                           std::size_t count) {
  std::uint32_t lost = 0;
  const std::uint16_t* const last = values.data() + values.size() - count;
  const std::uint16_t* const before = last - count;
  for (std::size_t i = 0; i < count; ++i)
    if (before[i] == next[i] && last[i] != next[i]) lost += 2;
  return lost;
}

}  // namespace

PointHooks::PointHooks(const Map& map)
    : map_(map),
      set_(map.points.size()),
      levels_(map.points.size()),
      has_input_lines_(std::any_of(map.points.begin(), map.points.end(), [](const Point& point) {
        return point.line.present() && point.table == Table::discrete_inputs;
      })) {
  const auto lines = static_cast<std::size_t>(std::count_if(
      map.points.begin(), map.points.end(), [](const Point& point) { return point.line.present(); }));
  wanted_.reserve(lines);
  taken_.reserve(lines);
}

void PointHooks::allow_setting(Waker* waker) {
  process_ = ::getpid();
  waker_ = waker;
}

std::string PointHooks::wrong_process() const {
  if (process_ == ::getpid()) return {};
  return "this process does not answer clients; values are set in serving_began(), in threads that it "
         "starts, or later";
}

tl::expected<void, std::string> PointHooks::drive(std::uint32_t point, bool level) {
  if (std::string wrong = wrong_process(); !wrong.empty()) return tl::unexpected(std::move(wrong));
  const std::lock_guard lock(mutex_);
  wanted_.erase(std::remove_if(wanted_.begin(), wanted_.end(),
                               [&](const WantedOutput& other) { return other.point == point; }),
                wanted_.end());
  wanted_.push_back({point, level});
  is_any_wanted_ = true;
  if (waker_ != nullptr) waker_->wake();
  return {};
}

Span<const WantedOutput> PointHooks::take_wanted_outputs() {
  if (!is_any_wanted_) return {};
  const std::lock_guard lock(mutex_);
  taken_.clear();
  std::swap(taken_, wanted_);
  is_any_wanted_ = false;
  return taken_;
}

bool PointHooks::take_level(std::uint32_t point, bool level, bool is_news) {
  const bool before = levels_[point].exchange(level, std::memory_order_relaxed);
  if (is_news && before != level && map_.points[point].table == Table::discrete_inputs)
    line_changed(point, level);
  return true;
}

void PointHooks::keep(std::uint32_t point, const std::uint16_t* registers) {
  const std::size_t count = range(map_.points[point]).count();
  const std::lock_guard lock(mutex_);
  const bool is_first = points_.empty();
  auto& [values, lost] = set_[point];
  if (values.empty()) points_.push_back(point);
  const bool are_told = holds_bits(map_.points[point].table);
  if (values.size() >= count * (are_told ? most_values : 1)) {  // nobody has asked for long
    if (are_told) lost += changes_lost(values, registers, count);
    values.resize(values.size() - count);
  }
  values.insert(values.end(), registers, registers + count);
  if (is_first && waker_ != nullptr) waker_->wake();
}

void PointHooks::replace_registers(std::uint32_t point, const std::uint16_t* registers) {
  {
    const std::lock_guard lock(mutex_);
    auto& [values, lost] = set_[point];  // nobody was to see these
    values.clear();
    lost = 0;
    points_.erase(std::remove(points_.begin(), points_.end(), point), points_.end());
  }
  keep(point, registers);
}

void PointHooks::put_new_values(Image& image, Changes& changes) {
  const std::lock_guard lock(mutex_);
  for (const std::uint32_t index : points_) {
    const Point& point = map_.points[index];
    const auto cells = image.find(point.table, range(point));
    const std::uint16_t mask = own_bits(point);
    auto& [values, lost] = set_[index];
    for (std::size_t begin = 0; begin < values.size(); begin += cells.size()) {
      if (begin + cells.size() == values.size() && lost != 0) changes.lose(std::exchange(lost, 0));
      for (std::size_t i = 0; i < cells.size(); ++i)
        cells[i] = static_cast<std::uint16_t>((cells[i] & ~mask) | (values[begin + i] & mask));
      changes.compare(point.table, range(point));
    }
    values.clear();
  }
  points_.clear();
}

}  // namespace coupler::device
