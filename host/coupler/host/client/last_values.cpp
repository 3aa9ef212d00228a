// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/client/last_values.hpp"

#include <algorithm>
#include <utility>

namespace coupler::client {

bool LastValues::keep(Entry& entry, const Point& point, const std::uint16_t* registers, host::Time at) {
  const bool first = !entry.value;
  if (first) entry.value.emplace();
  auto& kept = entry.value->registers;
  const std::uint16_t mask = own_bits(point);
  const auto equal = [mask](std::uint16_t a, std::uint16_t b) { return ((a ^ b) & mask) == 0; };
  const bool changed = !std::equal(kept.begin(), kept.end(), registers, equal);
  kept.assign(registers, registers + range(point).count());
  entry.value->at = at;
  entry.value->earlier = false;
  return first || changed;
}

void LastValues::begin() {
  const std::lock_guard lock(mutex_);
  for (Entry& entry : entries_)
    if (entry.value) entry.value->earlier = true;
}

void LastValues::set(const plan::ReadSpan& span, Span<const std::uint16_t> registers, host::Stamp stamp) {
  std::vector<News> news;
  {
    const std::lock_guard lock(mutex_);
    for (const std::uint32_t index : span.points) {
      const Point& point = map_.points[index];
      const std::uint16_t* value = &registers[read_range(point).start() - std::size_t{span.range.start()}];
      Entry& entry = entries_[index];
      if (keep(entry, point, value, stamp.at) && entry.listener) news.push_back({index, value});
    }
    came_.notify_all();
  }
  for (const News& each : news) tell(each, stamp);
}

void LastValues::tell(const News& news, host::Stamp stamp) {
  std::unique_lock lock(mutex_);
  auto listener = entries_[news.point].listener;
  if (!listener) return;
  called_ = news.point;
  ++calls_;
  caller_ = std::this_thread::get_id();
  lock.unlock();
  (*listener)(news.registers, stamp);
  listener.reset();  // so that one that was replaced is deleted before it is said to have returned
  lock.lock();
  called_.reset();
  returned_.notify_all();
}

void LastValues::listen(std::uint32_t point, Listener listener) {
  auto shared = listener ? std::make_shared<const Listener>(std::move(listener)) : nullptr;
  std::unique_lock lock(mutex_);
  shared.swap(entries_[point].listener);
  if (called_ != point || caller_ == std::this_thread::get_id()) return;
  returned_.wait(lock, [this, call = calls_] { return !called_ || calls_ != call; });
}

std::optional<LastValues::Value> LastValues::get(std::uint32_t point) const {
  const std::lock_guard lock(mutex_);
  return entries_[point].value;
}

std::optional<LastValues::Value> LastValues::wait(std::uint32_t point,
                                                  std::chrono::milliseconds at_most) const {
  std::unique_lock lock(mutex_);
  const std::optional<Value>& value = entries_[point].value;
  came_.wait_for(lock, at_most, [&] { return value && !value->earlier; });
  return value;
}

}  // namespace coupler::client
