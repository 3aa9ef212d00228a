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

void PointHooks::allow_setting(Waker* waker) {
  process_ = ::getpid();
  waker_ = waker;
}

std::string PointHooks::wrong_process() const {
  if (process_ == ::getpid()) return {};
  return "this process does not answer clients; values are set in serving_began(), in threads that it "
         "starts, or later";
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
