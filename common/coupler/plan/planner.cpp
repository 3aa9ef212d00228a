// SPDX-License-Identifier: Apache-2.0
#include "coupler/plan/planner.hpp"

#include <algorithm>
#include <map>
#include <tuple>

namespace coupler::plan {
namespace {

using modbus::Range;
using Reason = Cut::Reason;

std::uint32_t longest_reply(Table table) {
  return holds_bits(table) ? modbus::max_read_bits : modbus::max_read_registers;
}

std::uint32_t limit_of(const Map& map, Table table) {
  const std::uint32_t limit = holds_bits(table) ? map.limits.read_bits : map.limits.read_registers;
  return std::min(limit, longest_reply(table));
}

bool is_continuous(const Map& map, Table table) {
  return holds_bits(table) ? map.polling.discrete_continuous : map.polling.register_continuous;
}

std::uint32_t gap_of(const Map& map, Table table) {
  return holds_bits(table) ? map.polling.discrete_gap : map.polling.register_gap;
}

bool is_at(Table table, const TableRange& area, Range range) {
  return area.table == table && area.range.overlaps(range);
}

void sort_by_place(const Map& map, std::vector<std::uint32_t>& points) {
  const auto place = [&](std::uint32_t i) {
    const Point& point = map.points[i];
    return std::tuple(point.table, read_extent(map, point).start(), read_range(point).start(), i);
  };
  std::sort(points.begin(), points.end(),
            [&](std::uint32_t a, std::uint32_t b) { return place(a) < place(b); });
}

}  // namespace

std::optional<NotRead> why_not_read(const Map& map, const Point& point) {
  if (!is_readable(point)) return NotRead::write_only;
  const Range range = read_extent(map, point);
  if (range.count() > longest_reply(point.table)) return NotRead::too_long;
  for (const TableRange& area : map.unreadable)
    if (is_at(point.table, area, range)) return NotRead::unreadable;
  return std::nullopt;
}

Planner::Planner(const Map& map)
    : map_(map), scaled_(points_with_exponent(map)), is_exponent_(map.points.size()) {
  for (const ScaledPoint& each : scaled_) is_exponent_[each.exponent] = true;
  std::array<std::vector<Range>, tables.size()> readable;
  std::array<std::vector<Range>, tables.size()> write_only;
  std::array<std::vector<Range>, tables.size()> unreadable;
  for (const TableRange& area : map.unreadable) unreadable[index(area.table)].push_back(area.range);
  for (std::uint32_t i = 0; i < map.points.size(); ++i) {
    const Point& point = map.points[i];
    const auto reason = why_not_read(map, point);
    if (!reason) {
      order_.push_back(i);
      readable[index(point.table)].push_back(read_extent(map, point));
    } else if (reason == NotRead::write_only) {
      write_only[index(point.table)].push_back(range(point));
    }
  }
  for (const Table table : tables) {
    readable_[index(table)] = Intervals(std::move(readable[index(table)]));
    write_only_[index(table)] = Intervals(std::move(write_only[index(table)]));
    unreadable_[index(table)] = Intervals(std::move(unreadable[index(table)]));
  }
  sort_by_place(map, order_);
  std::map<double, std::vector<std::uint32_t>, std::greater<>> by_rate;
  for (const std::uint32_t i : order_) by_rate[rate_of(map, map.points[i])].push_back(i);
  for (auto& [rate, points] : by_rate) groups_.push_back({rate, std::move(points)});
}

std::vector<std::uint32_t> Planner::with_exponents(std::vector<std::uint32_t> points) const {
  if (scaled_.empty()) return points;
  std::vector<bool> is_in(map_.points.size());
  for (const std::uint32_t point : points) is_in[point] = true;
  const std::size_t given = points.size();
  for (const auto& [point, exponent] : scaled_)
    if (is_in[point] && !is_in[exponent]) {
      points.push_back(exponent);
      is_in[exponent] = true;
    }
  if (points.size() > given) sort_by_place(map_, points);
  return points;
}

std::array<Intervals, tables.size()> Planner::together(Span<const std::uint32_t> points) const {
  std::array<Intervals, tables.size()> result;
  if (scaled_.empty() || !joins_exponents_) return result;
  std::vector<bool> is_in(map_.points.size());
  for (const std::uint32_t point : points) is_in[point] = true;
  std::array<std::vector<Range>, tables.size()> ranges;
  for (const auto& [point, exponent] : scaled_) {
    const Table table = map_.points[point].table;
    const Range both = hull(read_extent(map_, map_.points[point]), read_extent(map_, map_.points[exponent]));
    const bool is_one_table = table == map_.points[exponent].table;
    if (is_in[point] && is_in[exponent] && is_one_table && both.count() <= limit_of(map_, table))
      ranges[index(table)].push_back(both);
  }
  for (const Table table : tables) result[index(table)] = Intervals(std::move(ranges[index(table)]));
  return result;
}

/// Returns the range of the point, up to the end of the exponent of its scale if that is read behind it and
/// one request can read both.
Range Planner::with_exponent_behind(std::uint32_t point, const std::vector<bool>& is_in) const {
  const Range own = read_extent(map_, map_.points[point]);
  const auto scaled = std::lower_bound(scaled_.begin(), scaled_.end(), point,
                                       [](const ScaledPoint& a, std::uint32_t i) { return a.point < i; });
  if (scaled == scaled_.end() || scaled->point != point || !is_in[scaled->exponent]) return own;
  const Point& exponent = map_.points[scaled->exponent];
  const Range both = hull(own, read_extent(map_, exponent));
  const Table table = map_.points[point].table;
  const bool is_possible = exponent.table == table && both.count() <= limit_of(map_, table);
  return is_possible && both.start() == own.start() ? both : own;
}

/// Returns the rate at which the span is read. Exponents are read at the rates of others, too.
double Planner::rate_of_span(const ReadSpan& span) const {
  const auto own = std::find_if(span.points.begin(), span.points.end(),
                                [this](std::uint32_t point) { return !is_exponent_[point]; });
  return rate_of(map_, map_.points[own == span.points.end() ? span.points.front() : *own]);
}

std::vector<ReadSpan> Planner::plan(Span<const std::uint32_t> points, Span<const TableRange> refused) const {
  std::vector<bool> is_in(has_exponents() ? map_.points.size() : 0);
  if (has_exponents())
    for (const std::uint32_t point : points) is_in[point] = true;
  const Wishes wishes{refused, together(points)};
  std::vector<ReadSpan> spans;
  const auto end_last = [&](Cut cut) {
    if (!spans.empty()) spans.back().end = cut;
  };
  for (const std::uint32_t i : points) {
    const Point& point = map_.points[i];
    const Range range = read_extent(map_, point);
    if (!spans.empty() && spans.back().table == point.table) {
      ReadSpan& last = spans.back();
      const auto apart =
          why_apart(last, range, has_exponents() ? with_exponent_behind(i, is_in) : range, wishes);
      if (!apart) {
        last.range = hull(last.range, range);
        last.points.push_back(i);
        continue;
      }
      last.end = {*apart, i, range.start() > last.range.end() ? range.start() - last.range.end() : 0};
    } else if (!spans.empty()) {
      end_last(last_cut(spans.back(), wishes));
    }
    spans.push_back({point.table, range, {i}});
  }
  if (!spans.empty()) end_last(last_cut(spans.back(), wishes));
  return spans;
}

bool Planner::refuses(Table table, Range range, Span<const TableRange> refused) const {
  return std::any_of(refused.begin(), refused.end(), [&](const TableRange& area) {
    return area.table == table && range.contains(area.range);
  });
}

std::optional<Reason> Planner::why_apart(const ReadSpan& span, Range next, Range needed,
                                         const Wishes& wishes) const {
  if (span.range.contains(next)) return std::nullopt;  // apart they would be the same request
  const Range both = hull(span.range, next);
  if (next.start() > span.range.end()) {
    const Range hole = Range::of(span.range.end(), next.start() - span.range.end());
    if (const auto reason = why_not_across(span.table, hole, wishes)) return reason;
  }
  if (refuses(span.table, both, wishes.refused)) return Reason::unreadable;
  if (hull(span.range, needed).count() > limit_of(map_, span.table)) return Reason::limit;
  return std::nullopt;
}

std::optional<Reason> Planner::why_not_across(Table table, Range hole, const Wishes& wishes) const {
  const std::size_t at = index(table);
  if (unreadable_[at].overlaps(hole)) return Reason::unreadable;
  if (!readable_[at].covers(hole)) {
    if (write_only_[at].overlaps(hole)) return Reason::write_only;
    if (!is_continuous(map_, table) && !wishes.together[at].covers(hole)) return Reason::unmapped;
  }
  if (hole.count() >= gap_of(map_, table) && !wishes.together[at].covers(hole)) return Reason::gap;
  return std::nullopt;
}

/// The span is the last one wanted of its table. Would the next point have been joined if its rate were the
/// same?
Cut Planner::last_cut(const ReadSpan& span, const Wishes& wishes) const {
  const auto next =
      std::lower_bound(order_.begin(), order_.end(), span, [&](std::uint32_t i, const ReadSpan& s) {
        const Point& point = map_.points[i];
        return point.table < s.table ||
               (point.table == s.table && read_extent(map_, point).start() < s.range.end());
      });
  if (next == order_.end() || map_.points[*next].table != span.table) return {};
  const Range range = read_extent(map_, map_.points[*next]);
  const bool same_rate = rate_of(map_, map_.points[*next]) == rate_of_span(span);
  if (same_rate || why_apart(span, range, range, wishes)) return {};
  return {Reason::other_rate, *next, static_cast<std::uint32_t>(range.start() - span.range.end())};
}

std::vector<GroupPlan> make_read_plan(const Map& map) {
  const Planner planner(map);
  std::vector<GroupPlan> plan;
  for (const RateGroup& group : planner.groups())
    plan.push_back({group.rate, planner.plan(planner.with_exponents(group.points))});
  return plan;
}

using modbus::Range;

Intervals::Intervals(std::vector<Range> ranges) {
  std::sort(ranges.begin(), ranges.end(), [](Range a, Range b) { return a.start() < b.start(); });
  for (const Range range : ranges) {
    if (!merged_.empty() && range.start() <= merged_.back().end())
      merged_.back() = hull(merged_.back(), range);
    else
      merged_.push_back(range);
  }
}

bool Intervals::covers(Range range) const {
  const auto next = std::upper_bound(merged_.begin(), merged_.end(), range.start(),
                                     [](std::uint32_t start, Range r) { return start < r.start(); });
  return next != merged_.begin() && std::prev(next)->contains(range);
}

bool Intervals::overlaps(Range range) const {
  const auto first = std::upper_bound(merged_.begin(), merged_.end(), range.start(),
                                      [](std::uint32_t start, Range r) { return start < r.end(); });
  return first != merged_.end() && first->overlaps(range);
}

}  // namespace coupler::plan
