// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "coupler/map/map.hpp"
#include "coupler/map/published.hpp"
#include "coupler/modbus/range.hpp"
#include "coupler/plan/read_span.hpp"

namespace coupler::plan {

/// A set of addresses of one table.
class Intervals {
 public:
  Intervals() = default;
  explicit Intervals(std::vector<modbus::Range> ranges);

  /// Every address of `range` is in the set.
  bool covers(modbus::Range range) const;
  /// At least one is.
  bool overlaps(modbus::Range range) const;

 private:
  std::vector<modbus::Range> merged_;  ///< sorted; none touches the next
};

/// Points that are read at the same rate.
struct RateGroup {
  double rate;                        ///< Hz
  std::vector<std::uint32_t> points;  ///< indices into Map::points, by table and address
};

/// How often the host reads a point, Hz: its own rate or the map's.
constexpr double rate_of(const Map& map, const Point& point) {
  return point.host.rate > 0 ? point.host.rate : map.polling.rate;
}

/// Why a point is never read.
enum class NotRead : std::uint8_t {
  write_only,
  unreadable,  ///< the map says so of an address that it occupies
  too_long     ///< no reply of Modbus has room for it (MAP 6.1 to 6.4)
};
std::optional<NotRead> why_not_read(const Map& map, const Point& point);

/// Makes the read requests of a map, for all points or for some, few of them: points are joined while they
/// touch or overlap, or, where unmapped addresses may be read, while fewer than the table's gap lie between
/// them, and as long as the device's limit allows. Addresses of points that are read at another rate, or not
/// wanted at the moment, do not count as unmapped. What lies between a point and the exponent of its
/// scale may be read, too, if both are among the points. A point is never split. What
/// Map::unreadable names, and points that can only be written, are not read even between others.
class Planner {
 public:
  /// The storage of `map` must outlive the planner.
  explicit Planner(const Map& map);

  /// Every point that can be read, the fastest rate first.
  const std::vector<RateGroup>& groups() const { return groups_; }

  bool has_exponents() const { return !scaled_.empty(); }
  /// From now on, what lies between a point and the exponent of its scale is not read for that alone.
  void keep_exponents_apart() { joins_exponents_ = false; }

  /// Adds the points that hold the exponents of the scales of `points`, so that they are read together.
  /// Both are in the order of a RateGroup.
  std::vector<std::uint32_t> with_exponents(std::vector<std::uint32_t> points) const;

  /// The requests for `points`, given in the order of a RateGroup; ordered by table and address. Points are
  /// not joined to a request that contains one of `refused`.
  std::vector<ReadSpan> plan(Span<const std::uint32_t> points, Span<const TableRange> refused = {}) const;

  /// A point that can be read has some of the addresses.
  bool has_points(Table table, modbus::Range range) const { return readable_[index(table)].overlaps(range); }

  const Map& map() const { return map_; }

 private:
  bool refuses(Table table, modbus::Range range, Span<const TableRange> refused) const;
  /// What the requests of a plan must respect, besides the map.
  struct Wishes {
    Span<const TableRange> refused;
    std::array<Intervals, tables.size()> together;  ///< from a point to the exponent of its scale
  };
  std::array<Intervals, tables.size()> together(Span<const std::uint32_t> points) const;
  modbus::Range with_exponent_behind(std::uint32_t point, const std::vector<bool>& is_in) const;
  double rate_of_span(const ReadSpan& span) const;
  /// `needed`: `next`, and what is to be read in the same request.
  std::optional<Cut::Reason> why_apart(const ReadSpan& span, modbus::Range next, modbus::Range needed,
                                       const Wishes& wishes) const;
  std::optional<Cut::Reason> why_not_across(Table table, modbus::Range hole, const Wishes& wishes) const;
  Cut last_cut(const ReadSpan& span, const Wishes& wishes) const;

  Map map_;
  std::vector<RateGroup> groups_;
  bool joins_exponents_ = true;
  std::vector<ScaledPoint> scaled_;   ///< by point
  std::vector<bool> is_exponent_;     ///< by point
  std::vector<std::uint32_t> order_;  ///< every point that can be read, by table and address
  std::array<Intervals, tables.size()> readable_;
  std::array<Intervals, tables.size()> write_only_;
  std::array<Intervals, tables.size()> unreadable_;
};

/// The requests of one rate, all its points wanted.
struct GroupPlan {
  double rate;  ///< Hz
  std::vector<ReadSpan> spans;
};

/// The whole plan of a map, the fastest rate first.
std::vector<GroupPlan> make_read_plan(const Map& map);

}  // namespace coupler::plan
