// SPDX-License-Identifier: Apache-2.0
#include "coupler/map/lock/allocate.hpp"

#include <algorithm>
#include <map>
#include <optional>
#include <tuple>
#include <unordered_set>

namespace coupler::lock {
namespace {

const std::vector<std::uint16_t>& masks_of(const Request& request) {
  static const std::vector<std::uint16_t> just_whole{whole};
  return request.masks.empty() ? just_whole : request.masks;
}

/// At the beginning of the place in the lock, whatever the alignment: that was right when the place was
/// given.
std::optional<Place> within(const Place& room, const Request& request) {
  if (request.size > room.range.count()) return std::nullopt;
  for (const std::uint16_t mask : masks_of(request))
    if ((mask & room.mask) == mask)
      return Place{room.table, modbus::Range::of(room.range.start(), request.size), mask};
  return std::nullopt;
}

class FirstFit {
 public:
  FirstFit(const FreeSpace& free_space, const Lock& lock) : open_(free_space.open) {
    for (const Place& place : free_space.closed) taken_.take(place);
    for (const Entry& entry : lock) taken_.take(entry.place);
  }

  /// Takes the place; nullopt: there is none.
  std::optional<Place> place(const Request& request) {
    std::uint32_t& at = next_[{request.table, request.size, request.alignment, masks_of(request)}];
    for (; modbus::Range::make(at, request.size); at += request.alignment) {
      if (const auto found = place_at(at, request)) {
        taken_.take(*found);
        return found;
      }
    }
    return std::nullopt;
  }

 private:
  /// The data that requests of one kind share. An address without room for one of them has none for the next,
  /// because places are never given back.
  using Kind = std::tuple<Table, std::uint32_t, std::uint16_t, std::vector<std::uint16_t>>;

  std::optional<Place> place_at(std::uint32_t address, const Request& request) const {
    const auto range = modbus::Range::of(address, request.size);
    if (!is_open(request.table, range)) return std::nullopt;
    for (const std::uint16_t mask : masks_of(request)) {
      const Place place{request.table, range, mask};
      if (taken_.is_free(place)) return place;
    }
    return std::nullopt;
  }

  bool is_open(Table table, modbus::Range range) const {
    bool limited = false;
    for (const Place& area : open_) {
      if (area.table != table) continue;
      if (area.range.contains(range)) return true;
      limited = true;
    }
    return !limited;
  }

  const std::vector<Place>& open_;
  Occupancy taken_;
  std::map<Kind, std::uint32_t> next_;
};

Answer answer(const Request& request, const Entry* known, Unknown unknown, FirstFit& free) {
  if (known != nullptr) {
    const auto place = within(known->place, request);
    return place ? Answer{Answer::Kind::recalled, *place, known} : Answer{Answer::Kind::misfit, {}, known};
  }
  if (unknown == Unknown::refused) return {Answer::Kind::unknown};
  const auto place = free.place(request);
  return place ? Answer{Answer::Kind::allocated, *place} : Answer{Answer::Kind::full};
}

}  // namespace

Allocation allocate(const std::vector<Request>& requests, const FreeSpace& free_space, const Lock& lock,
                    Unknown unknown) {
  const Names names(lock);
  FirstFit free(free_space, lock);
  Allocation result;
  result.answers.reserve(requests.size());
  std::unordered_set<const Entry*> asked_for;
  for (const Request& request : requests) {
    const Entry* known = names.find(request.table, request.name);
    result.answers.push_back(answer(request, known, unknown, free));
    asked_for.insert(known);
    const Answer& last = result.answers.back();
    if (last.kind == Answer::Kind::allocated) result.lock.push_back({last.place, std::string(request.name)});
  }
  for (const Entry& entry : lock)
    result.lock.push_back({entry.place, entry.name, asked_for.count(&entry) == 0, entry.line});
  std::sort(result.lock.begin(), result.lock.end(),
            [](const Entry& a, const Entry& b) { return less(a.place, b.place); });
  return result;
}

}  // namespace coupler::lock
