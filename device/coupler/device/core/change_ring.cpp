// SPDX-License-Identifier: Apache-2.0
#include "coupler/device/core/change_ring.hpp"

#include <algorithm>
#include <cassert>
#include <limits>

namespace coupler::device {

void ChangeRing::begin(std::uint32_t epoch) {
  assert(epoch != 0);
  epoch_ = epoch;
  first_ = count_ = 0;
  newest_ = 0;
}

void ChangeRing::add(const modbus::Change& change, const ClientSession* owner) {
  ++newest_;
  if (places_.empty()) return;
  places_[(first_ + count_) % places_.size()] = {newest_, change, owner};
  if (count_ < places_.size())
    ++count_;
  else
    first_ = (first_ + 1) % places_.size();
}

/// Numbers ascend, with gaps where changes were lost.
std::size_t ChangeRing::first_after(std::uint64_t seen) const {
  std::size_t first = 0;
  std::size_t end = count_;
  while (first != end) {
    const std::size_t middle = first + (end - first) / 2;
    if (kept(middle).number > seen)
      end = middle;
    else
      first = middle + 1;
  }
  return first;
}

const ChangeRing::Entry* ChangeRing::next_after(std::uint64_t number) const {
  const std::size_t first = first_after(number);
  return first < count_ ? &kept(first) : nullptr;
}

modbus::ChangesReply ChangeRing::reply_to(const modbus::ChangesRequest& request) const {
  modbus::ChangesReply reply;
  reply.epoch = epoch_;
  reply.newest = newest_;
  if (begins_anew(request)) return reply;
  std::size_t i = first_after(request.seen);
  const std::uint64_t next = i < count_ ? kept(i).number : newest_ + 1;
  const std::uint64_t lost = next - 1 - request.seen;
  constexpr auto most = std::numeric_limits<std::uint32_t>::max();
  reply.lost = static_cast<std::uint32_t>(std::min<std::uint64_t>(lost, most));
  if (lost > most) return reply;  // the next request goes on from there
  for (; i < count_ && reply.count < modbus::max_changes && kept(i).number == next + reply.count; ++i)
    reply.changes[reply.count++] = kept(i).change;
  return reply;
}

}  // namespace coupler::device
