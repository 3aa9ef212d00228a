// SPDX-License-Identifier: Apache-2.0
#include "coupler/map/loader/areas.hpp"

#include <algorithm>
#include <tuple>

#include <fmt/format.h>

namespace coupler::loader {
namespace {

std::optional<std::uint16_t> read_end(const Reader& area, std::string_view key, Table table,
                                      Addressing addressing, Context& context) {
  const Entry& entry = *area.find(key);
  const auto address = parse_address(entry.kind == Entry::Kind::scalar ? entry.text : "", table, addressing);
  if (address) return *address;
  context.problems.error(entry.at, address.error().what, address.error().remedy);
  return std::nullopt;
}

std::optional<Area> read_area(const Entry& entry, std::string_view key, Addressing addressing,
                              Context& context) {
  const Reader area(entry, Section::area, context);
  if (entry.kind != Entry::Kind::map || !area.missing().empty()) {
    context.problems.error(entry.at, fmt::format("an area of '{}' has 'table', 'from' and 'to'", key),
                           fmt::format("write it as in '{}: [{{table: coils, from: 8, to: 15}}]'", key));
    return std::nullopt;
  }
  const std::size_t errors = context.problems.errors();
  Table table = Table::coils;
  area.choice("table", table);
  if (context.problems.errors() != errors) return std::nullopt;
  const auto from = read_end(area, "from", table, addressing, context);
  const auto to = read_end(area, "to", table, addressing, context);
  if (!from || !to) return std::nullopt;
  if (*to >= *from) return Area{table, modbus::Range::of(*from, *to - *from + 1U), entry.at};
  context.problems.error(area.find("to")->at, "the area ends before it begins",
                         "write the smaller one as 'from'");
  return std::nullopt;
}

}  // namespace

Areas read_areas(const Reader& top, std::string_view key, Addressing addressing, Context& context) {
  Areas areas;
  const Entry* entry = top.find(key);
  if (entry == nullptr) return areas;
  if (entry->kind != Entry::Kind::list) {
    top.wrong(key, "a list of areas");
    return areas;
  }
  for (const Entry& child : entry->children)
    if (const auto area = read_area(child, key, addressing, context)) areas.push_back(*area);
  return areas;
}

void check_unreadable(const Areas& areas, const DraftPoints& points, Context& context) {
  for (const Area& area : areas) {
    for (const DraftPoint& draft : points) {
      const Point& point = draft.point;
      if (!draft.placed || !is_readable(point) || point.table != area.table ||
          !read_range(point).overlaps(area.range))
        continue;
      context.problems.error(draft.address_at,
                             fmt::format("{} is read from an area that is 'unreadable' (line {})",
                                         shown(point.name), area.at.line),
                             "give it 'access: write', or make the area smaller",
                             {{area.at, "the area is here"}});
    }
  }
}

void check_reserved(const Areas& areas, const DraftPoints& points, Context& context) {
  for (const Area& area : areas) {
    for (const DraftPoint& draft : points) {
      const Point& point = draft.point;
      if (!draft.placed || point.table != area.table || !range(point).overlaps(area.range)) continue;
      context.problems.error(draft.address_at,
                             fmt::format("{} ({} {}) is in the reserved area {} to {} (line {})",
                                         shown(point.name), to_string(point.table), point.address,
                                         area.range.start(), area.range.last(), area.at.line),
                             draft.addressless
                                 ? "make the area smaller: the lock has given the address before"
                                 : "give it an address outside, or make the area smaller",
                             {{area.at, "the area is here"}});
    }
  }
}

std::vector<Unreadable> sorted_unreadable(const Areas& areas) {
  std::vector<Unreadable> sorted;
  for (const Area& area : areas) sorted.push_back({area.table, area.range});
  std::sort(sorted.begin(), sorted.end(), [](const Unreadable& a, const Unreadable& b) {
    return std::tuple(index(a.table), a.range.start()) < std::tuple(index(b.table), b.range.start());
  });
  return sorted;
}

}  // namespace coupler::loader
