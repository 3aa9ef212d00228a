// SPDX-License-Identifier: Apache-2.0
#include "coupler/device/core/edge_points.hpp"

#include <algorithm>

#include "coupler/codec/number.hpp"
#include "coupler/device/core/each_point.hpp"

namespace coupler::device {
namespace {

using modbus::Range;

std::uint32_t of_kind(Edge edge, const Edges& edges) {
  switch (edge) {
    case Edge::rising: return edges.rising;
    case Edge::falling: return edges.falling;
    case Edge::both: break;
  }
  return edges.rising + edges.falling;
}

template <class T>
void raise(std::uint16_t* registers, codec::Order order, std::uint32_t by) {
  codec::encode(static_cast<T>(codec::decode<T>(registers, order) + by), order, registers);
}

std::uint16_t mask_of(const Point& point) {
  return holds_bits(point.table) ? std::uint16_t{1} : codec::mask(point.format);
}

void count(const EdgePoints::Link& link, std::uint32_t edges) {
  const codec::Order order = link.point->format.order;
  switch (codec::registers(link.point->format)) {
    case 1: return raise<std::uint16_t>(link.cells, order, edges);
    case 2: return raise<std::uint32_t>(link.cells, order, edges);
    default: return raise<std::uint64_t>(link.cells, order, edges);
  }
}

/// Calls `use` with each point, the edges that it wants, and whether it latches them.
template <class Use>
void each_wish(const Map& map, Use use) {
  for (const Point& point : map.points) {
    if (point.counter.present()) use(point, point.counter, false);
    if (point.latched.present()) use(point, point.latched, true);
  }
}

}  // namespace

EdgePoints::EdgePoints(const Map& map, Image& image, Statistics& statistics, Span<Link> links,
                       Changes& changes)
    : map_(map), statistics_(statistics), changes_(changes) {
  if (links.empty()) return;  // to look at all points of a large map takes its time, and clients wait
  std::size_t used = 0;
  each_wish(map, [&](const Point& point, const EdgeOf& wish, bool latches) {
    const Point* input = find(map, wish.input);
    if (input == nullptr) return;
    links[used++] = {input->address, wish.edge, latches, &point,
                     image.find(point.table, range(point)).data()};
  });
  links_ = links.first(used);
  std::sort(links_.begin(), links_.end(), [](const Link& a, const Link& b) { return a.input < b.input; });
}

void EdgePoints::add(std::uint16_t input, const Edges& edges) {
  statistics_.events_lost += edges.lost;
  const auto* link = std::lower_bound(links_.begin(), links_.end(), input,
                                      [](const Link& l, std::uint16_t wanted) { return l.input < wanted; });
  for (; link != links_.end() && link->input == input; ++link) {
    const std::uint32_t happened = of_kind(link->edge, edges);
    if (!link->latches) {
      count(*link, happened);
    } else if (happened != 0) {
      *link->cells = static_cast<std::uint16_t>(*link->cells | mask_of(*link->point));
      changes_.compare(link->point->table, range(*link->point));
    }
  }
}

void EdgePoints::keep_latches(Table table, Range written, Span<const std::uint16_t> now,
                              Span<std::uint16_t> next) const {
  each_point(map_, table, written.start(), written.end(), [&](const Point& point) {
    if (!point.latched.present()) return;
    const std::size_t i = point.address - written.start();
    const std::uint16_t mask = mask_of(point);
    next[i] = static_cast<std::uint16_t>(next[i] & (now[i] | ~mask));
  });
}

}  // namespace coupler::device
