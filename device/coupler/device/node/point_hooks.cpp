// SPDX-License-Identifier: Apache-2.0
#include "coupler/device/node/point_hooks.hpp"

#include <unistd.h>

#include <mutex>

namespace coupler::device {

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
  if (set_[point].empty()) points_.push_back(point);
  set_[point].assign(registers, registers + count);
  if (is_first && waker_ != nullptr) waker_->wake();
}

void PointHooks::put_new_values(Image& image, Changes& changes) {
  const std::lock_guard lock(mutex_);
  for (const std::uint32_t index : points_) {
    const Point& point = map_.points[index];
    const auto cells = image.find(point.table, range(point));
    const std::uint16_t mask = own_bits(point);
    for (std::size_t i = 0; i < cells.size(); ++i)
      cells[i] = static_cast<std::uint16_t>((cells[i] & ~mask) | (set_[index][i] & mask));
    changes.compare(point.table, range(point));
    set_[index].clear();
  }
  points_.clear();
}

}  // namespace coupler::device
