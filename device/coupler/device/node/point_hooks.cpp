// SPDX-License-Identifier: Apache-2.0
#include "coupler/device/node/point_hooks.hpp"

#include <unistd.h>

#include <algorithm>
#include <mutex>

namespace coupler::device {
namespace {

constexpr std::size_t most_values = 16;

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
  std::vector<std::uint16_t>& values = set_[point];
  if (values.empty()) points_.push_back(point);
  const bool is_full = values.size() >= count * (holds_bits(map_.points[point].table) ? most_values : 1);
  if (is_full) values.resize(values.size() - count);  // nobody has asked for long
  values.insert(values.end(), registers, registers + count);
  if (is_first && waker_ != nullptr) waker_->wake();
}

void PointHooks::replace_registers(std::uint32_t point, const std::uint16_t* registers) {
  {
    const std::lock_guard lock(mutex_);
    if (!set_[point].empty()) set_[point].clear();
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
    std::vector<std::uint16_t>& values = set_[index];
    for (std::size_t begin = 0; begin < values.size(); begin += cells.size()) {
      for (std::size_t i = 0; i < cells.size(); ++i)
        cells[i] = static_cast<std::uint16_t>((cells[i] & ~mask) | (values[begin + i] & mask));
      changes.compare(point.table, range(point));
    }
    values.clear();
  }
  points_.clear();
}

}  // namespace coupler::device
