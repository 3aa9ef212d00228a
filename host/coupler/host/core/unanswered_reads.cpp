// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/core/unanswered_reads.hpp"

#include <algorithm>

namespace coupler::host {
namespace {

auto same_as(const plan::ReadSpan& span) {
  return [&span](const TableRange& place) { return place.table == span.table && place.range == span.range; };
}

void remove(std::vector<TableRange>& places, const plan::ReadSpan& span) {
  places.erase(std::remove_if(places.begin(), places.end(), same_as(span)), places.end());
}

}  // namespace

void UnansweredReads::suspect(const plan::ReadSpan& span) {
  if (!is_suspected(span)) suspects_.push_back({span.table, span.range});
}

bool UnansweredReads::is_suspected(const plan::ReadSpan& span) const {
  return std::any_of(suspects_.begin(), suspects_.end(), same_as(span)) ||
         std::any_of(guilty_.begin(), guilty_.end(), [&](const TableRange& whole) {
           return whole.table == span.table && whole.range.contains(span.range);
         });
}

void UnansweredReads::convict(const plan::ReadSpan& span) {
  remove(suspects_, span);
  remove(guilty_, span);
  guilty_.push_back({span.table, span.range});
}

void UnansweredReads::add(const plan::ReadSpan& span, Time now) {
  entries_.push_back({{span.table, span.range}, span.points, shortest, now + shortest});
}

std::vector<UnansweredReads::Entry>::iterator UnansweredReads::find(const plan::ReadSpan& span) {
  return std::find_if(entries_.begin(), entries_.end(),
                      [is_same = same_as(span)](const Entry& entry) { return is_same(entry.place); });
}

bool UnansweredReads::failed_again(const plan::ReadSpan& span, Time now) {
  const auto entry = find(span);
  if (entry == entries_.end()) return false;
  entry->pause = std::min(2 * entry->pause, longest);
  entry->again = now + entry->pause;
  entry->is_tried = false;
  return true;
}

bool UnansweredReads::answered(const plan::ReadSpan& span) {
  if (suspects_.empty() && entries_.empty()) return false;
  remove(suspects_, span);
  const auto entry = find(span);
  if (entry == entries_.end()) return false;
  entries_.erase(entry);
  remove(guilty_, span);
  return true;
}

bool UnansweredReads::has(const plan::ReadSpan& span) const {
  return std::any_of(entries_.begin(), entries_.end(),
                     [is_same = same_as(span)](const Entry& entry) { return is_same(entry.place); });
}

Time UnansweredReads::due() const {
  Time earliest = Time::max();
  for (const Entry& entry : entries_)
    if (!entry.is_tried) earliest = std::min(earliest, entry.again);
  return earliest;
}

std::vector<std::uint32_t> UnansweredReads::take_due(Time now) {
  std::vector<std::uint32_t> points;
  for (Entry& entry : entries_) {
    if (entry.is_tried || entry.again > now) continue;
    entry.is_tried = true;
    points.insert(points.end(), entry.points.begin(), entry.points.end());
  }
  return points;
}

std::vector<std::uint32_t> UnansweredReads::take_back() {
  std::vector<std::uint32_t> points;
  for (Entry& entry : entries_) {
    entry.is_tried = false;
    points.insert(points.end(), entry.points.begin(), entry.points.end());
  }
  return points;
}

}  // namespace coupler::host
