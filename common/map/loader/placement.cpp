// SPDX-License-Identifier: Apache-2.0
#include "common/map/loader/placement.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "common/map/identity.hpp"
#include "common/map/loader/lock_messages.hpp"

namespace coupler::loader {
namespace {

using lock::Answer;
using lock::Place;

/// Where the point of the file stands, or may stand: once for each half or bit that it leaves open, the best
/// first.
std::vector<codec::Format> formats_of(const DraftPoint& draft) {
  codec::Format format = draft.point.format;
  std::vector<codec::Format> formats;
  if (draft.part_given || !is_partial(draft.point)) return {format};
  if (format.type != codec::Type::BOOL) {
    for (const codec::Half half : {codec::Half::high, codec::Half::low}) {
      format.half = half;
      formats.push_back(format);
    }
    return formats;
  }
  for (format.bit = 0; format.bit < 16; ++format.bit) formats.push_back(format);
  return formats;
}

std::uint16_t mask_of(const DraftPoint& draft, const codec::Format& format) {
  return is_partial(draft.point) ? codec::mask(format) : lock::whole;
}

lock::Request request_of(const DraftPoint& draft) {
  const Point& point = draft.point;
  lock::Request request{point.name, point.table, range(point).count()};
  const bool wide = !holds_bits(point.table) && point.format.type != codec::Type::STRING;
  if (wide) request.alignment = codec::registers(point.format);
  for (const codec::Format& format : formats_of(draft)) request.masks.push_back(mask_of(draft, format));
  return request;
}

void settle(DraftPoint& draft, const Place& place) {
  draft.point.address = place.range.start();
  for (const codec::Format& format : formats_of(draft)) {
    if (mask_of(draft, format) != place.mask) continue;
    draft.point.format = format;
    break;
  }
  draft.placed = true;
}

void renew(const lock::Lock& lock, Placement& placement) {
  if (lock::equal(lock, placement.known)) return;
  const lock::Names known(placement.known);
  for (const lock::Entry& entry : lock) {
    const lock::Entry* before = known.find(entry.place.table, entry.name);
    if (before == nullptr || before->retired == entry.retired) continue;
    if (placement.file.use == LockUse::exact) tell_stale(entry, placement);
    if (entry.retired) placement.renewed.retired.push_back(entry.name);
  }
  placement.renewed.path = placement.file.path;
  placement.renewed.text = lock::print(lock);
}

}  // namespace

lock::Ground ground_of(const DraftPoints& points, const Areas& reserved, const Areas& unreadable,
                       const std::optional<Preset>& preset) {
  lock::Ground ground;
  ground.closed.push_back({Table::input_registers, identity::reserved});
  ground.closed.push_back({Table::holding_registers, identity::reserved});
  for (const Areas* areas : {&reserved, &unreadable})
    for (const Area& area : *areas) ground.closed.push_back({area.table, area.range});
  for (const DraftPoint& draft : points) {
    const Point& point = draft.point;
    if (draft.placed) ground.closed.push_back({point.table, range(point), mask_of(draft, point.format)});
    if (point.read_address) ground.closed.push_back({point.table, read_range(point)});
  }
  if (!preset) return ground;
  for (const Preset::Area& area : preset->areas) ground.open.push_back({area.table, area.range});
  for (const Preset::ReadBack& back : preset->read_back)
    ground.closed.push_back(
        {back.from.table, modbus::Range::of(back.from.range.start() + back.offset, back.from.range.count())});
  return ground;
}

void place_points(DraftPoints& points, const lock::Ground& ground, Placement& placement, Context& context) {
  std::vector<DraftPoint*> drafts;
  std::vector<lock::Request> requests;
  for (DraftPoint& draft : points) {
    if (!draft.addressless) continue;
    drafts.push_back(&draft);
    requests.push_back(request_of(draft));
  }
  if (requests.empty() && placement.known.empty()) return;
  const bool may_grow = placement.file.use == LockUse::renew && !placement.file.path.empty();
  const lock::Allocation allocation = lock::allocate(
      requests, ground, placement.known, may_grow ? lock::Unknown::allocated : lock::Unknown::refused);
  std::vector<const DraftPoint*> unknown;
  for (std::size_t i = 0; i < drafts.size(); ++i) {
    DraftPoint& draft = *drafts[i];
    const Answer& answer = allocation.answers[i];
    switch (answer.kind) {
      case Answer::Kind::allocated:
        placement.renewed.allocated.emplace_back(draft.point.name);
        [[fallthrough]];
      case Answer::Kind::recalled: settle(draft, answer.place); break;
      case Answer::Kind::misfit: tell_misfit(draft, requests[i], *answer.entry, placement, context); break;
      case Answer::Kind::unknown: unknown.push_back(&draft); break;
      case Answer::Kind::full: tell_full(draft, requests[i], context); break;
    }
  }
  tell_unknown(unknown, allocation.lock, placement, context);
  tell_reused(points, allocation.lock, placement, context);
  renew(allocation.lock, placement);
}

}  // namespace coupler::loader
