// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/core/poll_cycle.hpp"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "coupler/plan/read_span.hpp"
#include "coupler/plan/split_span.hpp"

namespace coupler::host {

std::string to_string(const RejectedRange& rejected) {
  const auto table = to_string(rejected.table);
  const unsigned first = rejected.range.start();
  const unsigned last = rejected.range.last();
  if (rejected.between_points)
    return fmt::format(
        "the device rejects {0} {1} to {2}, which lie between points; they are left out while this "
        "connection "
        "lasts. To leave them out always, add to the map (zero-based addresses): unreadable: [{{table: {0}, "
        "from: {1}, to: {2}}}]",
        table, first, last);
  return fmt::format(
      "the device rejects {} {} to {} in one request; they are read in parts. If it takes fewer than {} in "
      "one "
      "request, add to the map: limits: {{{}: ...}}",
      table, first, last, rejected.range.count(),
      holds_bits(rejected.table) ? "read_bits" : "read_registers");
}

PollCycle::PollCycle(const Map& map)
    : planner_(map),
      wanted_(map.points.size(), true),
      given_up_(map.points.size(), false),
      at_rest_(map.points.size(), false) {
  for (const plan::RateGroup& points : planner_.groups())
    groups_.push_back({&points, PollDeadlines(period_of(points.rate))});
}

void PollCycle::start(Time now) {
  rejected_ranges_ = aside_.ranges();
  given_up_.assign(given_up_.size(), false);
  for (const std::uint32_t point : aside_.take_back()) given_up_[point] = true;
  for (const ReadSpan& span : deferred_)
    for (const std::uint32_t point : span.points) given_up_[point] = true;
  give_up_left_out();
  at_rest_.assign(at_rest_.size(), false);
  findings_.clear();
  others_first_ = false;
  for (Group& group : groups_) {
    group.next = 0;
    group.parted.clear();
    group.joined_again = false;
    group.has_parts = false;
    group.steps.clear();  // with an empty one replan() begins the deadlines
    replan(group, now);
  }
}

/// Gives up the points of leave_out(). No request may include their addresses, because the device may have
/// something else there; unless it gives them only together with those of another point.
void PollCycle::give_up_left_out() {
  for (const std::uint32_t point : left_out_) {
    const Point& left_out = planner_.map().points[point];
    given_up_[point] = true;
    rejected_ranges_.push_back({left_out.table, read_range(left_out)});
  }
}

void PollCycle::want(std::uint32_t point, bool wanted) {
  if (wanted_[point] == wanted) return;
  wanted_[point] = wanted;
  if (Group* const group = group_of(point)) group->stale = true;
}

void PollCycle::rest(std::uint32_t point, bool at_rest) {
  if (at_rest_[point] == at_rest) return;
  at_rest_[point] = at_rest;
  if (Group* const group = group_of(point)) group->stale = true;
}

void PollCycle::read_soon(std::uint32_t point) {
  at_rest_[point] = false;
  if (Group* const group = group_of(point)) group->stale = group->soon = true;
}

/// nullptr if no point of its rate can be read.
PollCycle::Group* PollCycle::group_of(std::uint32_t point) {
  const double rate = plan::rate_of(planner_.map(), planner_.map().points[point]);
  const auto found = std::find_if(groups_.begin(), groups_.end(),
                                  [rate](const Group& group) { return group.points->rate == rate; });
  return found == groups_.end() ? nullptr : &*found;
}

Time PollCycle::Group::due() const {
  if (soon && idle()) return Time::min();
  if (steps.empty()) return stale ? Time::min() : Time::max();
  return deadlines.due();
}

Time PollCycle::due() const {
  Time earliest = aside_.due();
  for (const Group& group : groups_) earliest = std::min(earliest, group.due());
  return earliest;
}

bool PollCycle::is_overdue(Time now) const {
  return std::any_of(groups_.begin(), groups_.end(), [now](const Group& group) {
    // A request out of turn, and points that are read again after a rest, have no deadline to count from.
    if ((group.soon && group.idle()) || (group.steps.empty() && group.stale)) return true;
    return !group.steps.empty() && group.deadlines.due() + group.deadlines.period() <= now;
  });
}

const ReadSpan* PollCycle::select(Time now) {
  if (aside_.due() <= now) ask_again(aside_.take_due(now));
  std::optional<std::size_t> chosen;
  for (std::size_t i = 0; i < groups_.size(); ++i) {
    Group& group = groups_[i];
    if (group.stale && group.idle()) replan(group, now);
    if (group.due() > now) continue;
    if (!chosen || (others_first_ && group.served < groups_[*chosen].served)) chosen = i;
  }
  if (!chosen) return nullptr;
  current_ = *chosen;
  return &current();
}

void PollCycle::ask_again(Span<const std::uint32_t> points, bool soon) {
  for (const std::uint32_t point : points) {
    given_up_[point] = false;
    if (Group* const group = group_of(point)) {
      group->stale = true;
      group->soon |= soon;
    }
  }
  if (planner_.has_exponents())  // which several groups may read
    for (Group& group : groups_) group.stale = true;
}

bool PollCycle::answered(std::optional<modbus::Exception> exception, Time now) {
  Group& group = groups_[current_];
  const bool is_back = aside_.answered(current());
  for (const ReadSpan& span : std::exchange(deferred_, {})) ask_again(span.points, only_looks_);
  const bool news = std::exchange(group.steps[group.next].last, exception) != exception || is_back;
  ++group.next;
  done(now);
  return news;
}

PollCycle::Parts PollCycle::parts_of_current() const {
  const ReadSpan& whole = current();
  Parts result;
  // If points overlap, a part can be as large as the whole, and need not be read.
  std::vector<ReadSpan> open{whole};
  while (!open.empty()) {
    const ReadSpan span = std::move(open.back());
    open.pop_back();
    if (span.range != whole.range) {
      result.pieces.push_back(span);
      continue;
    }
    plan::Split parts = split(span, planner_.map());
    if (parts.pieces.empty()) result.alone.push_back(span.points.front());
    open.insert(open.end(), parts.pieces.rbegin(), parts.pieces.rend());
    result.hole = parts.hole;
  }
  return result;
}

void PollCycle::replace_current(const Parts& parts, bool keeps_alone) {
  Group& group = groups_[current_];
  const auto part_of = step().part_of;
  const ReadSpan alone{current().table, current().range, parts.alone};
  remove_current();
  const auto insert = [&](std::size_t at, const ReadSpan& span) {
    group.steps.insert(group.steps.begin() + static_cast<std::ptrdiff_t>(at), {span, std::nullopt, part_of});
  };
  if (keeps_alone && !alone.points.empty()) insert(group.next++, alone);
  std::size_t next = group.next;
  for (const ReadSpan& span : parts.pieces) insert(next++, span);
}

std::vector<std::uint32_t> PollCycle::rejected(Time now) { return part(only_looks_, now); }

/// Asks for current() in parts from now on. What is alone is given up, or stays in the cycle.
std::vector<std::uint32_t> PollCycle::part(bool keeps_alone, Time now) {
  Group& group = groups_[current_];
  const TableRange whole{current().table, current().range};
  const auto is_whole = [&](const TableRange& known) {
    return known.table == whole.table && known.range == whole.range;
  };
  if (std::none_of(rejected_ranges_.begin(), rejected_ranges_.end(), is_whole))
    rejected_ranges_.push_back(whole);
  const Parts parts = parts_of_current();
  std::vector<std::uint32_t> alone = parts.alone;
  if (!keeps_alone) {
    const auto is_known = [this](std::uint32_t point) { return given_up_[point]; };  // by another group
    alone.erase(std::remove_if(alone.begin(), alone.end(), is_known), alone.end());
    for (const std::uint32_t point : alone) given_up_[point] = true;
  }
  if (parts.alone.empty()) group.parted.push_back({whole, parts.hole});
  replace_current(parts, keeps_alone);
  done(now);
  return alone;
}

std::optional<std::vector<std::uint32_t>> PollCycle::failed(Time now) {
  Group& group = groups_[current_];
  const Parts parts = parts_of_current();
  if (parts.pieces.empty()) return std::nullopt;
  if (auto& part_of = group.steps[group.next].part_of; !part_of)
    part_of = std::make_shared<const ReadSpan>(current());
  replace_current(parts, true);
  group.has_parts = true;
  done(now);
  return parts.alone;
}

std::vector<std::uint32_t> PollCycle::set_aside(Time now) {
  const ReadSpan span = current();
  if (aside_.failed_again(span, now)) {
    give_up(now);
    return {};
  }
  aside_.convict(span);
  std::vector<std::uint32_t> left = part(false, now);
  if (!left.empty()) aside_.add({span.table, span.range, left}, now);
  return left;
}

void PollCycle::ended_connection() {
  if (current().points.size() > 1)
    planner_.keep_exponents_apart();  // the device may ignore what lies between
  aside_.suspect(current());
  deferred_.push_back(current());
  std::size_t asked = 0;
  for (const Group& group : groups_)
    for (const std::uint32_t point : group.points->points) asked += is_read(point) ? 1 : 0;
  if (current().points.size() >= asked) deferred_.clear();  // there are no others: all of it is silent
}

void PollCycle::give_up(Time now) {
  for (const std::uint32_t point : current().points) given_up_[point] = true;
  remove_current();
  done(now);
}

void PollCycle::try_again() {
  const bool any = std::find(given_up_.begin(), given_up_.end(), true) != given_up_.end();
  if (!any && rejected_ranges_.empty()) return;
  given_up_.assign(given_up_.size(), false);
  rejected_ranges_.clear();
  give_up_left_out();
  for (Group& group : groups_) {
    group.stale = group.soon = true;
    group.joined_again = false;
  }
}

std::vector<RejectedRange> PollCycle::take_rejected_ranges() { return std::exchange(findings_, {}); }

std::vector<PollCycle::Status> PollCycle::status() const {
  std::vector<Status> result;
  result.reserve(groups_.size());
  for (const Group& group : groups_)
    result.push_back({group.points->rate, group.steps.size(), group.deadlines.overruns()});
  return result;
}

std::uint64_t PollCycle::overruns() const {
  std::uint64_t sum = 0;
  for (const Group& group : groups_) sum += group.deadlines.overruns();
  return sum;
}

void PollCycle::replan(Group& group, Time now) {
  std::vector<std::uint32_t> points;
  for (const std::uint32_t point : group.points->points)
    if (is_read(point) && !at_rest_[point]) points.push_back(point);
  points = planner_.with_exponents(std::move(points));
  points.erase(std::remove_if(points.begin(), points.end(), [this](std::uint32_t i) { return given_up_[i]; }),
               points.end());
  const std::vector<Step> old = std::exchange(group.steps, {});
  for (ReadSpan& span : planner_.plan(points, rejected_ranges_)) {
    const auto same = std::find_if(old.begin(), old.end(), [&](const Step& step) {
      return step.last && step.span.table == span.table && step.span.range == span.range;
    });
    const auto last = same == old.end() ? std::nullopt : same->last;
    group.steps.push_back({std::move(span), last});
  }
  if (old.empty() || group.soon) group.deadlines.start(now);
  group.stale = group.soon = false;
}

void PollCycle::remove_current() {
  Group& group = groups_[current_];
  group.steps.erase(group.steps.begin() + static_cast<std::ptrdiff_t>(group.next));
}

void PollCycle::done(Time now) {
  Group& group = groups_[current_];
  group.served = ++requests_;
  others_first_ = false;
  if (group.next < group.steps.size()) return;
  group.next = 0;
  cycle_time_ = now - group.deadlines.due();
  group.deadlines.advance(now);
  others_first_ = due() <= now;
  if (!group.parted.empty()) learn(group);
  if (std::exchange(group.has_parts, false)) join_parts(group);
}

/// Joins the parts of each failed request again, so that the next cycle sends it as a whole.
void PollCycle::join_parts(Group& group) {
  std::shared_ptr<const ReadSpan> last;
  std::vector<Step> steps;
  for (Step& step : group.steps) {
    const auto whole = std::exchange(step.part_of, nullptr);
    if (!whole)
      steps.push_back(std::move(step));
    else if (whole != last)
      steps.push_back({*whole, std::nullopt, nullptr});
    last = whole;
  }
  group.steps = std::move(steps);
}

/// The parts of all that was rejected have been read. Where no smaller part was rejected, the hole between
/// the parts is the cause, or, without a hole, the length of the request. Parts that need not be apart are
/// joined again in the next cycle.
void PollCycle::learn(Group& group) {
  const std::vector<TableRange> all = rejected_ranges_;
  const auto holds_smaller = [&all](const TableRange& whole) {
    return std::any_of(all.begin(), all.end(), [&](const TableRange& other) {
      return other.table == whole.table && other.range != whole.range && whole.range.contains(other.range);
    });
  };
  rejected_ranges_.erase(std::remove_if(rejected_ranges_.begin(), rejected_ranges_.end(), holds_smaller),
                         rejected_ranges_.end());
  bool found_hole = false;
  for (const auto& [whole, hole] : std::exchange(group.parted, {})) {
    if (holds_smaller(whole)) continue;
    // With points of another rate in it, the hole is an unlikely cause.
    const bool blame_hole = hole && !planner_.has_points(whole.table, *hole);
    findings_.push_back({whole.table, blame_hole ? *hole : whole.range, blame_hole});
    if (blame_hole) rejected_ranges_.push_back({whole.table, *hole});
    found_hole = found_hole || blame_hole;
  }
  if (found_hole && !std::exchange(group.joined_again, true)) group.stale = true;
}

}  // namespace coupler::host
