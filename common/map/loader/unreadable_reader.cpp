// SPDX-License-Identifier: Apache-2.0
#include "common/map/loader/unreadable_reader.hpp"

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

std::optional<Unreadable> read_area(const Entry& entry, Addressing addressing, Context& context) {
  const Reader area(entry, Section::area, context);
  if (entry.kind != Entry::Kind::map || !area.missing().empty()) {
    context.problems.error(entry.at, "an area of 'unreadable' has 'table', 'from' and 'to'",
                           "write it as in 'unreadable: [{table: coils, from: 8, to: 15}]'");
    return std::nullopt;
  }
  const std::size_t errors = context.problems.errors();
  Table table = Table::coils;
  area.choice("table",
              {Table::coils, Table::discrete_inputs, Table::input_registers, Table::holding_registers},
              table);
  if (context.problems.errors() != errors) return std::nullopt;
  const auto from = read_end(area, "from", table, addressing, context);
  const auto to = read_end(area, "to", table, addressing, context);
  if (!from || !to) return std::nullopt;
  if (*to >= *from) return Unreadable{table, modbus::Range::of(*from, *to - *from + 1U)};
  context.problems.error(area.find("to")->at, "the area ends before it begins",
                         "write the smaller one as 'from'");
  return std::nullopt;
}

void check_points(const Unreadable& area, const Entry& entry, const DraftPoints& points, Context& context) {
  for (const DraftPoint& draft : points) {
    const Point& point = draft.point;
    if (!draft.placed || !is_readable(point) || point.table != area.table ||
        !read_range(point).overlaps(area.range))
      continue;
    context.problems.error(draft.address_at,
                           fmt::format("{} is read from an area that is 'unreadable' (line {})",
                                       shown(point.name), entry.at.line),
                           "give it 'access: write', or make the area smaller");
  }
}

}  // namespace

std::vector<Unreadable> read_unreadable(const Reader& top, const DraftPoints& points, Addressing addressing,
                                        Context& context) {
  std::vector<Unreadable> areas;
  const Entry* entry = top.find("unreadable");
  if (entry == nullptr) return areas;
  if (entry->kind != Entry::Kind::list) {
    top.wrong("unreadable", "a list of areas");
    return areas;
  }
  for (const Entry& child : entry->children)
    if (const auto area = read_area(child, addressing, context)) {
      check_points(*area, child, points, context);
      areas.push_back(*area);
    }
  std::sort(areas.begin(), areas.end(), [](const Unreadable& a, const Unreadable& b) {
    return std::tuple(index(a.table), a.range.start()) < std::tuple(index(b.table), b.range.start());
  });
  return areas;
}

}  // namespace coupler::loader
