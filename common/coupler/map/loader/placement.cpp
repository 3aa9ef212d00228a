// SPDX-License-Identifier: Apache-2.0
#include "coupler/map/loader/placement.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "coupler/map/identity.hpp"

namespace coupler::loader {
namespace {

using lock::Answer;
using lock::Place;

/// The formats that the point may have: one for each half or bit that the file leaves open, the best first.
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

std::string size_text(const lock::Request& request) {
  const std::string_view noun = holds_bits(request.table) ? "bit" : "register";
  if (request.masks.front() == lock::whole)
    return fmt::format("{} {}{}", request.size, noun, request.size == 1 ? "" : "s");
  const bool is_bit = (request.masks.front() & (request.masks.front() - 1)) == 0;
  const std::string_view part = is_bit ? "bit" : "half";
  return fmt::format("{} {} of a register", request.masks.size() == 1 ? "one certain" : "one", part);
}

/// "'a' has", "'a', 'b' and 7 more have".
std::string subject(const std::vector<const DraftPoint*>& points) {
  constexpr std::size_t most = 10;
  const std::size_t named = std::min(points.size(), most);
  std::string text;
  for (std::size_t i = 0; i < named; ++i) {
    const bool last = i + 1 == points.size();
    text += fmt::format("{}{}", i == 0 ? "" : last ? " and " : ", ", shown(points[i]->point.name));
  }
  if (points.size() > most) text += fmt::format(" and {} more", points.size() - most);
  return text + (points.size() == 1 ? " has" : " have");
}

lock::Place place_of(const Point& point) {
  return {point.table, range(point), is_partial(point) ? codec::mask(point.format) : lock::whole};
}

void report_misfit(const DraftPoint& draft, const lock::Request& request, const lock::Entry& entry,
                   const Placement& placement, const Context& context) {
  context.problems.error(
      draft.name_at,
      fmt::format("{} needs {} and does not fit its place any more, {} ({}, line {})",
                  shown(draft.point.name), size_text(request), to_string(entry.place), placement.file.path,
                  entry.line),
      "give it another name, or an address of its own; or delete that line of the lock, and it gets a new "
      "address");
}

void report_full(const DraftPoint& draft, const lock::Request& request, const Context& context) {
  context.problems.error(
      draft.name_at,
      fmt::format("no place is left in {} for {}, which needs {}", to_string(draft.point.table),
                  shown(draft.point.name), size_text(request)),
      "make reserved areas smaller, or remove points");
}

void report_unknown(const std::vector<const DraftPoint*>& points, const lock::Lock& renewed,
                    const Placement& placement, const Context& context) {
  if (points.empty()) return;
  const Position at = points.front()->name_at;
  const std::string who = subject(points);
  const LockFile& file = placement.file;
  if (file.path.empty())
    return context.problems.error(at, who + " no address",
                                  "write 'address: NUMBER'; or put the map into a file: `coupler check FILE` "
                                  "then gives out addresses and "
                                  "keeps them in FILE.lock");
  if (!file.text)
    return context.problems.error(
        at, fmt::format("{} no address, and there is no {}", who, file.path),
        fmt::format("run `coupler check {}`, and keep the lock that it writes beside the map",
                    placement.map));
  std::string remedy =
      fmt::format("run `coupler check {}`, and keep the new lock beside the map", placement.map);
  const auto retired =
      std::find_if(renewed.begin(), renewed.end(), [](const lock::Entry& entry) { return entry.retired; });
  if (retired != renewed.end())
    remedy += fmt::format(
        "; a renamed point keeps its address if its new name replaces the old one there, as {} in line {}",
        shown(retired->name), retired->line);
  context.problems.error(at, fmt::format("{} no address in {}", who, file.path), std::move(remedy));
}

void report_reused(const DraftPoints& points, const lock::Lock& renewed, const Placement& placement,
                   const Context& context) {
  lock::Occupancy retired;
  for (const lock::Entry& entry : renewed)
    if (entry.retired) retired.take(entry.place);
  for (const DraftPoint& draft : points) {
    if (!draft.placed || draft.addressless) continue;
    const lock::Place place = place_of(draft.point);
    if (retired.is_free(place)) continue;
    const auto entry = std::find_if(renewed.begin(), renewed.end(), [&](const lock::Entry& other) {
      return other.retired && other.name != draft.point.name && overlap(other.place, place);
    });
    if (entry == renewed.end()) continue;
    context.problems.warning(
        draft.address_at,
        fmt::format("{} is at {}, where {} was ({}, line {})", shown(draft.point.name), to_string(place),
                    shown(entry->name), placement.file.path, entry->line),
        fmt::format("give it another address; or delete that line, if no client uses {} any more",
                    shown(entry->name)));
  }
}

void report_stale(const lock::Entry& entry, Placement& placement) {
  placement.problems.push_back(
      {Diagnostic::Severity::error, placement.file.path, entry.line, 1,
       entry.retired ? fmt::format("the map has no {} without an address any more", shown(entry.name))
                     : fmt::format("{} is a point of the map again", shown(entry.name)),
       fmt::format("run `coupler check {}`, and commit the lock", placement.map)});
}

void renew(const lock::Lock& lock, Placement& placement) {
  if (lock::equal(lock, placement.known)) return;
  const lock::Names known(placement.known);
  for (const lock::Entry& entry : lock) {
    const lock::Entry* before = known.find(entry.place.table, entry.name);
    if (before == nullptr || before->retired == entry.retired) continue;
    if (placement.file.use == LockUse::exact) report_stale(entry, placement);
    if (entry.retired) placement.renewed.retired.push_back(entry.name);
  }
  placement.renewed.path = placement.file.path;
  placement.renewed.text = lock::print(lock);
}

}  // namespace

lock::FreeSpace free_space_of(const DraftPoints& points, const Areas& reserved, const Areas& unreadable,
                              const std::optional<Preset>& preset) {
  lock::FreeSpace free_space;
  free_space.closed.push_back({Table::input_registers, identity::reserved});
  free_space.closed.push_back({Table::holding_registers, identity::reserved});
  for (const Areas* areas : {&reserved, &unreadable})
    for (const Area& area : *areas) free_space.closed.push_back({area.table, area.range});
  for (const DraftPoint& draft : points) {
    const Point& point = draft.point;
    if (draft.placed) free_space.closed.push_back({point.table, range(point), mask_of(draft, point.format)});
    if (point.read_address) free_space.closed.push_back({point.table, read_range(point)});
  }
  if (!preset) return free_space;
  for (const Preset::Area& area : preset->areas) free_space.open.push_back({area.table, area.range});
  for (const Preset::ReadBack& back : preset->read_back)
    free_space.closed.push_back(
        {back.from.table, modbus::Range::of(back.from.range.start() + back.offset, back.from.range.count())});
  return free_space;
}

void place_points(DraftPoints& points, const lock::FreeSpace& free_space, Placement& placement,
                  const Context& context) {
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
      requests, free_space, placement.known, may_grow ? lock::Unknown::allocated : lock::Unknown::refused);
  std::vector<const DraftPoint*> unknown;
  for (std::size_t i = 0; i < drafts.size(); ++i) {
    DraftPoint& draft = *drafts[i];
    const Answer& answer = allocation.answers[i];
    switch (answer.kind) {
      case Answer::Kind::allocated:
        placement.renewed.allocated.emplace_back(draft.point.name);
        [[fallthrough]];
      case Answer::Kind::recalled: settle(draft, answer.place); break;
      case Answer::Kind::misfit: report_misfit(draft, requests[i], *answer.entry, placement, context); break;
      case Answer::Kind::unknown: unknown.push_back(&draft); break;
      case Answer::Kind::full: report_full(draft, requests[i], context); break;
    }
  }
  report_unknown(unknown, allocation.lock, placement, context);
  report_reused(points, allocation.lock, placement, context);
  renew(allocation.lock, placement);
}

}  // namespace coupler::loader
