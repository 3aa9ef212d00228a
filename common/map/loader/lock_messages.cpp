// SPDX-License-Identifier: Apache-2.0
#include "common/map/loader/lock_messages.hpp"

#include <algorithm>

#include <fmt/format.h>

namespace coupler::loader {
namespace {

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

}  // namespace

void tell_misfit(const DraftPoint& draft, const lock::Request& request, const lock::Entry& entry,
                 const Placement& placement, Context& context) {
  context.problems.error(
      draft.name_at,
      fmt::format("{} needs {} and does not fit its place any more, {} ({}, line {})",
                  shown(draft.point.name), size_text(request), to_string(entry.place), placement.file.path,
                  entry.line),
      "give it another name, or an address of its own; or delete that line of the lock, and it gets a new "
      "address");
}

void tell_full(const DraftPoint& draft, const lock::Request& request, Context& context) {
  context.problems.error(
      draft.name_at,
      fmt::format("no place is left in {} for {}, which needs {}", to_string(draft.point.table),
                  shown(draft.point.name), size_text(request)),
      "make reserved areas smaller, or remove points");
}

void tell_unknown(const std::vector<const DraftPoint*>& points, const lock::Lock& renewed,
                  const Placement& placement, Context& context) {
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

void tell_reused(const DraftPoints& points, const lock::Lock& renewed, const Placement& placement,
                 Context& context) {
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
        fmt::format("give it another address; or delete that line, if nobody asks for {} any more",
                    shown(entry->name)));
  }
}

void tell_stale(const lock::Entry& entry, Placement& placement) {
  placement.problems.push_back(
      {Diagnostic::Severity::error, placement.file.path, entry.line, 1,
       entry.retired ? fmt::format("the map has no {} without an address any more", shown(entry.name))
                     : fmt::format("{} is a point of the map again", shown(entry.name)),
       fmt::format("run `coupler check {}`, and commit the lock", placement.map)});
}

}  // namespace coupler::loader
