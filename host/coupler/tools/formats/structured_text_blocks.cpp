// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstdint>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "coupler/map/functions.hpp"
#include "coupler/plan/planner.hpp"
#include "coupler/tools/formats/structured_text.hpp"

namespace coupler::formats::structured_text {
namespace {

/// Writing it does more than to set it, or the map wants it by itself.
bool is_written_alone(const Point& point) {
  return point.counter.present() || point.latched.present() ||
         point.host.write_function == HostOptions::WriteFunction::single;
}

modbus::Function write_function(const Block& block, const Map& map) {
  using Wanted = HostOptions::WriteFunction;
  const bool multiple = std::any_of(block.points.begin(), block.points.end(), [&](std::uint32_t i) {
    return map.points[i].host.write_function == Wanted::multiple;
  });
  return coupler::write_function(block.table, block.range.count(),
                                 multiple ? Wanted::multiple : Wanted::automatic);
}

}  // namespace

std::vector<Block> read_blocks(const Map& map) {
  std::vector<Block> blocks;
  std::vector<Point> points(map.points.begin(), map.points.end());
  for (Point& point : points) point.scale.exponent_of = {};  // which the blocks do not use
  Map without_exponents = map;
  without_exponents.points = points;
  for (const plan::GroupPlan& group : plan::make_read_plan(without_exponents))
    for (const plan::ReadSpan& span : group.spans)
      blocks.push_back({span.table, span.range, read_function(span.table), group.rate, span.points, {}});
  return blocks;
}

std::vector<Block> write_blocks(const Map& map) {
  std::vector<Block> blocks;
  const Point* last = nullptr;
  for (std::uint32_t i = 0; i < map.points.size(); ++i) {
    const Point& point = map.points[i];
    if (!is_writable(point)) continue;
    const modbus::Range place = range(point);
    if (last != nullptr && last->table == point.table) {
      Block& block = blocks.back();
      const std::uint32_t most = holds_bits(point.table) ? map.limits.write_bits : map.limits.write_registers;
      const std::uint32_t count = std::max(block.range.end(), place.end()) - block.range.start();
      const bool follows = place.start() == block.range.end() && !is_written_alone(*last) &&
                           !is_written_alone(point) && count <= most;
      if (follows || place.start() < block.range.end()) {
        block.range = modbus::Range::of(block.range.start(), count);
        block.points.push_back(i);
        last = &point;
        continue;
      }
    }
    blocks.push_back({point.table, place, modbus::Function::write_multiple_registers, 0, {i}, {}});
    last = &point;
  }
  for (Block& block : blocks) block.function = write_function(block, map);
  return blocks;
}

std::string initial_image(const Block& block, const Map& map) {
  const bool bits = holds_bits(block.table);
  std::vector<unsigned> cells(bits ? (block.range.count() + 7) / 8 : block.range.count());
  for (const std::uint32_t i : block.points) {
    std::uint32_t at = map.points[i].address - block.range.start();
    for (const std::uint16_t word : start_registers(map.points[i])) {
      if (bits)
        cells[at / 8] |= static_cast<unsigned>(word) << at % 8;
      else
        cells[at] |= word;  // the bits of other points are zero in it
      ++at;
    }
  }
  if (std::all_of(cells.begin(), cells.end(), [](unsigned cell) { return cell == 0; })) return {};
  constexpr std::size_t in_a_line = 12;
  std::string list;
  for (std::size_t i = 0; i < cells.size(); ++i)
    list += fmt::format("{}16#{:0{}X}",
                        i == 0               ? ""
                        : i % in_a_line == 0 ? ",\n      "
                                             : ", ",
                        cells[i], bits ? 2 : 4);
  return "[" + list + "]";
}

std::vector<ReadOnlyBits> read_only_bits(const Map& map, const std::vector<Block>& reads,
                                         const std::vector<Block>& writes) {
  std::vector<ReadOnlyBits> all;
  for (std::uint32_t i = 0; i < map.points.size(); ++i) {
    const Point& point = map.points[i];
    if (is_writable(point) || !is_partial(point)) continue;
    const auto has = [&](std::uint32_t address) {
      return [&point, address](const Block& block) {
        return block.table == point.table && block.range.start() <= address && address < block.range.end();
      };
    };
    for (std::uint32_t address = range(point).start(); address < range(point).end(); ++address) {
      const auto written = std::find_if(writes.begin(), writes.end(), has(address));
      if (written == writes.end()) continue;
      const auto read = std::find_if(reads.begin(), reads.end(), has(address));
      all.push_back({i, codec::mask(point.format), static_cast<std::uint16_t>(address), &*written,
                     read == reads.end() ? nullptr : &*read});
    }
  }
  return all;
}

}  // namespace coupler::formats::structured_text
