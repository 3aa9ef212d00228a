// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/core/deadmen.hpp"

#include <algorithm>

namespace coupler::host {

Deadmen::Deadmen(const Map& map) {
  for (std::uint32_t i = 0; i < map.points.size(); ++i) {
    const HostOptions::Deadman& deadman = map.points[i].host.deadman;
    if (!deadman.present() || !is_writable(map.points[i])) continue;
    Entry& entry = entries_.emplace_back();
    entry.point = i;
    entry.timeout = deadman.timeout;
  }
}

Deadmen::Entry* Deadmen::find(std::uint32_t point) {
  const auto found = std::lower_bound(entries_.begin(), entries_.end(), point,
                                      [](const Entry& entry, std::uint32_t p) { return entry.point < p; });
  return found != entries_.end() && found->point == point ? &*found : nullptr;
}

bool Deadmen::fed(std::uint32_t point, Time now) {
  Entry* const entry = find(point);
  if (entry == nullptr) return false;
  entry->again = false;
  return entry->deadline.exchange((now + entry->timeout).time_since_epoch().count()) == disarmed;
}

Time Deadmen::due() const {
  Time::rep earliest = disarmed;
  for (const Entry& entry : entries_) earliest = std::min(earliest, entry.deadline.load());
  return Time(Duration(earliest));
}

std::optional<Deadmen::Expired> Deadmen::take_expired(Time now) {
  for (Entry& entry : entries_) {
    Time::rep deadline = entry.deadline.load();
    if (deadline > now.time_since_epoch().count()) continue;
    if (entry.deadline.compare_exchange_strong(deadline, disarmed)) return Expired{entry.point, entry.again};
  }
  return std::nullopt;
}

void Deadmen::put_back(const Expired& expired) {
  retry(expired.point, Time());
  if (Entry* const entry = find(expired.point)) entry->again = expired.again;
}

void Deadmen::retry(std::uint32_t point, Time when) {
  Entry* const entry = find(point);
  Time::rep expected = disarmed;  // unless a message has armed it meanwhile
  if (entry != nullptr && entry->deadline.compare_exchange_strong(expected, when.time_since_epoch().count()))
    entry->again = true;
}

}  // namespace coupler::host
