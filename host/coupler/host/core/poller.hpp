// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "coupler/host/core/bit_changes.hpp"
#include "coupler/host/core/device_statistics.hpp"
#include "coupler/host/core/link.hpp"
#include "coupler/host/core/poll_cycle.hpp"
#include "coupler/host/core/sink.hpp"
#include "coupler/host/core/value_table.hpp"
#include "coupler/host/core/writer.hpp"
#include "coupler/modbus/limits.hpp"

namespace coupler::host {

/// Reads one device: makes the requests of the polling cycle, stores the values, and tells the sink.
///
/// A value is not stored if it was requested before a newer one was written: the old value would flicker
/// back. Nor is it stored if older changes are still to come: see BitChanges.
class Poller {
 public:
  /// All references must outlive the poller.
  Poller(const Map& map, Link& link, Writer& writer, DeviceStatistics& statistics, ValueTable& values,
         Sink& sink);

  /// Makes it the poller of a program that only looks, see Purpose. Call it before start().
  void only_look() { cycle_.only_look(); }

  /// Starts with a new connection. `is_node`: it leads to a node of this project. `told`: the node tells
  /// changes of its bits.
  void start(bool is_node, bool told);
  /// The time at which step() has something to do.
  Time due() const { return cycle_.due(); }
  /// See PollCycle.
  bool is_overdue(Time now) const { return cycle_.is_overdue(now); }
  /// Returns whether step() would send a request now.
  bool has_request(Time now) { return cycle_.select(now) != nullptr; }
  /// Sends the request that is due, if there is one and its turn comes before `until`. An error means that
  /// the connection can no longer be used, or that the unit is away. Any other exception is not an error.
  Result<> step(Time until = Time::max());

  // The request of step() has ended the connection. See PollCycle.
  void ended_connection() { cycle_.ended_connection(); }
  bool is_suspected() const { return cycle_.is_suspected(); }
  void acquit() { cycle_.acquit(); }
  TableRange current() const { return {cycle_.current().table, cycle_.current().range}; }
  void set_aside(const Error& error);
  /// The range that was answered last over any connection; nullopt if there is none.
  const std::optional<TableRange>& last_answered() const { return answered_; }

  /// Returns whether a cycle has ended since the last call.
  bool take_ended_cycle() { return std::exchange(has_ended_cycle_, false); }
  /// See PollCycle.
  void leave_out(std::vector<std::uint32_t> points) { cycle_.leave_out(std::move(points)); }
  void want(std::uint32_t point, bool wanted) { told_.want(point, wanted); }
  /// The receiver of changes.
  ChangeSink& changes() { return told_; }

 private:
  void publish(const ReadSpan& span);
  void tell_late();
  void tell_apart(Span<const std::uint32_t> points);
  const ReadSpan& without_hidden(const ReadSpan& span);
  void on_exception(modbus::Exception code);
  bool ask_in_parts(modbus::Exception code);
  void request_ended();
  void on_rejection(modbus::Exception code, std::string_view what, std::string_view until);
  void report_rejected_ranges();
  std::string describe(const ReadSpan& span) const;

  const Map& map_;
  Link& link_;
  Clock& clock_;
  Writer& writer_;
  DeviceStatistics& statistics_;
  ValueTable& values_;
  Sink& sink_;
  PollCycle cycle_;
  BitChanges told_;
  std::optional<TableRange> answered_;
  bool has_ended_cycle_ = false;
  bool is_node_ = false;  ///< a node knows every function, so exception 01 is about rights
  ReadSpan rest_{Table::coils, modbus::Range::of(0, 1), {}};  ///< a member, so that its memory is used again
  std::vector<std::uint32_t> usable_;                         ///< of the last reply
  std::vector<std::uint32_t> unusable_;                       ///< of the last reply
  std::array<std::uint16_t, modbus::max_read_bits> read_{};   ///< the registers or bits of the last reply
};

}  // namespace coupler::host
