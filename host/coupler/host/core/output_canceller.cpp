// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/core/output_canceller.hpp"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "coupler/map/functions.hpp"
#include "coupler/modbus/scheduled_output.hpp"

namespace coupler::host {
namespace {

using modbus::NodeTime;
using modbus::Range;

constexpr auto cancelled_result = ScheduledOutcome::Result::cancelled;

/// The node, or a gateway before it, has refused the request, and the connection is as before.
bool is_refusal(const Error& error) { return exception_in(error) != nullptr && !is_unit_away(error); }

}  // namespace

Result<> OutputCanceller::answer(std::uint32_t number, Reply<CallAnswer>& to,
                                 const ChangeListener& listener) {
  const std::string reason = to_string(modbus::Reason::client);
  if (by_driver_.cancel(number, reason)) {
    to.set_value({true, "cancelled"});
    return {};
  }
  const auto at_node = by_node_.number_at_node(number);
  if (!at_node) {
    to.set_value(
        by_driver_.has(number)
            ? CallAnswer{false, "too late: it is being written"}
            : CallAnswer{false, fmt::format("no write {} waits: it was carried out, or there was none; "
                                            "list_scheduled names those that wait",
                                            number)});
    return {};
  }
  Result<> done = cancel(*at_node, reason, listener);
  if (done) {
    to.set_value({true, "cancelled"});
    return {};
  }
  if (!is_refusal(done.error())) {
    to.set_value({false, std::string(in_doubt) + to_string(done.error())});
    return done;
  }
  to.set_value(
      {false,
       "too late: it has begun, or the device has ended it; its outcome comes on the topic scheduled"});
  return {};
}

Result<> OutputCanceller::answer(const WritesFrom& which, Reply<CallAnswer>& to,
                                 const ChangeListener& listener) {
  const std::string reason = to_string(modbus::Reason::client);
  Counts counts = cancel_by_driver(which, reason);
  Result<> done = cancel_at_node(which, reason, listener, counts);
  const std::size_t left = counts.wanted - counts.cancelled;
  if (!done)
    to.set_value({false, fmt::format("{} of {} may or may not be carried out: {}", left, counts.wanted,
                                     to_string(done.error()))});
  else if (left > 0)
    to.set_value({false, fmt::format("too late for {} of {}: they have begun, or the device has ended them; "
                                     "their outcomes come on the topic scheduled",
                                     left, counts.wanted)});
  else
    to.set_value({true, fmt::format("{} cancelled", counts.cancelled)});
  return done;
}

OutputCanceller::Counts OutputCanceller::cancel_by_driver(const WritesFrom& which,
                                                          const std::string& reason) {
  Counts counts;
  for (const std::uint32_t number : by_driver_.numbers_of(which)) {
    ++counts.wanted;
    if (by_driver_.cancel(number, reason)) ++counts.cancelled;
  }
  return counts;
}

Result<> OutputCanceller::cancel_at_node(const WritesFrom& which, const std::string& reason,
                                         const ChangeListener& listener, Counts& counts) {
  std::vector<Output> wanted;
  std::vector<Output> others;
  for (const NodeOutputs::Waiting& one : by_node_.waiting())
    (which.has(one.what.what) ? wanted : others).push_back(output(one));
  if (wanted.empty()) return {};
  counts.wanted += wanted.size();
  const auto is_earlier = [](const Output& a, const Output& b) { return a.due < b.due; };
  const NodeTime from = std::min_element(wanted.begin(), wanted.end(), is_earlier)->due;
  // The node leaves alone what is due before.
  others.erase(
      std::remove_if(others.begin(), others.end(), [&](const Output& one) { return one.due < from; }),
      others.end());

  std::vector<Output> left;
  for (const Group& group : groups_of(std::move(wanted), others)) {
    const bool is_alone = !overlap(group.table, group.range, others);
    const Result<bool> cancelled =
        is_alone && !asks_for_each_ ? cancel(group, from, reason, listener, counts) : false;
    if (!cancelled) return tl::make_unexpected(cancelled.error());
    if (!*cancelled) left.insert(left.end(), group.outputs.begin(), group.outputs.end());
  }
  std::stable_sort(left.begin(), left.end(), is_earlier);
  for (const Output& one : left) {
    if (!by_node_.has(one.number)) continue;  // the answer to the wait has told its outcome
    Result<> done = cancel(one.number, reason, listener);
    if (done)
      ++counts.cancelled;
    else if (!is_refusal(done.error()))
      return done;
  }
  return {};
}

OutputCanceller::Output OutputCanceller::output(const NodeOutputs::Waiting& waiting) const {
  const Point& point = map_.points[waiting.what.what.write.point];
  return {waiting.number, waiting.node_due, point.table, range(point)};
}

bool OutputCanceller::overlap(Table table, Range range, const std::vector<Output>& outputs) {
  return std::any_of(outputs.begin(), outputs.end(),
                     [&](const Output& one) { return one.table == table && one.range.overlaps(range); });
}

/// Those of a group have no other output between them.
std::vector<OutputCanceller::Group> OutputCanceller::groups_of(std::vector<Output> wanted,
                                                               const std::vector<Output>& others) {
  const auto place = [](const Output& one) { return std::pair(one.table, one.range.start()); };
  std::stable_sort(wanted.begin(), wanted.end(),
                   [&](const Output& a, const Output& b) { return place(a) < place(b); });
  std::vector<Group> groups;
  for (const Output& one : wanted) {
    if (!groups.empty() && groups.back().table == one.table) {
      Group& last = groups.back();
      const std::uint32_t start = last.range.start();
      const std::uint32_t count = std::max(last.range.end(), one.range.end()) - start;
      // A request has 16 bits for it.
      if (count <= 0xFFFF && !overlap(one.table, Range::of(start, count), others)) {
        last.range = Range::of(start, count);
        last.outputs.push_back(one);
        continue;
      }
    }
    groups.push_back({one.table, one.range, {one}});
  }
  return groups;
}

/// Returns false if the node refuses to cancel them with one request.
Result<bool> OutputCanceller::cancel(const Group& group, NodeTime from, const std::string& reason,
                                     const ChangeListener& listener, Counts& counts) {
  const std::uint32_t epoch = listener.epoch().value_or(0);
  const auto reply = link_.schedule(
      modbus::ScheduleRequest::cancel_from({epoch, from, read_function(group.table), group.range}));
  if (reply) {
    counts.cancelled += settle(group, *reply, reason);
    return true;
  }
  if (!is_refusal(reply.error())) return tl::make_unexpected(reply.error());
  // In another epoch it says so of every request.
  const bool is_same = listener.epoch() == epoch;
  if (is_same && exception_in(reply.error())->code == modbus::Exception::illegal_data_value)
    asks_for_each_ = true;
  return false;
}

/// Returns how many were cancelled. Those that were not have an outcome of their own, which the node tells.
std::size_t OutputCanceller::settle(const Group& group, const modbus::ScheduleReply& reply,
                                    const std::string& reason) {
  std::vector<Output> waiting;
  for (const Output& one : group.outputs)
    if (by_node_.has(one.number)) waiting.push_back(one);
  // It has driven what was due by then before it looked at the request.
  const auto in_time = std::stable_partition(waiting.begin(), waiting.end(),
                                             [&](const Output& one) { return one.due > reply.arrived; });
  const auto in_time_count = static_cast<std::size_t>(in_time - waiting.begin());
  if (reply.number < waiting.size()) {
    if (reply.number != in_time_count) return reply.number;  // its changes will say which
    waiting.erase(in_time, waiting.end());
  }
  for (const Output& one : waiting) by_node_.settle(one.number, cancelled_result, reason);
  return waiting.size();
}

Result<> OutputCanceller::cancel(std::uint16_t number, const std::string& reason,
                                 const ChangeListener& listener) {
  const auto reply = link_.schedule(modbus::ScheduleRequest::cancel({listener.epoch().value_or(0), number}));
  if (!reply) return tl::make_unexpected(reply.error());
  by_node_.settle(number, cancelled_result, reason);
  return {};
}

}  // namespace coupler::host
