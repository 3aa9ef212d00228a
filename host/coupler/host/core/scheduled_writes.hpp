// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <list>
#include <string>
#include <vector>

#include "coupler/host/core/scheduled.hpp"
#include "coupler/host/core/writer.hpp"

namespace coupler::host {

/// The scheduled writes that the driver makes with its own timer, for devices without one. They are queued
/// when their time has come.
///
/// They have no duration: an output that ends by itself needs a timer that does not end with the driver.
///
/// Another write to the point cancels those that wait, unless it was scheduled, too. Only the thread that
/// owns the connection may use the object.
class ScheduledWrites {
 public:
  /// All references must outlive the object.
  ScheduledWrites(Link& link, Writer& writer, ScheduledListener& outcomes);

  void add(const AcceptedWrite& what);
  /// Returns whether the one with that number waits or is being written.
  bool has(std::uint32_t number) const { return find(number) != entries_.end(); }
  /// Returns whether one to the point waits or is being written.
  bool has_point(std::uint32_t point) const;
  /// Returns the numbers of those that wait or are being written.
  std::vector<std::uint32_t> numbers_of(const WritesFrom& which) const;
  /// The number of those that wait or are being written.
  std::size_t size() const { return entries_.size(); }

  /// The time at which queue_due() has something to do; Time::max() if there is nothing.
  Time due() const { return due_; }
  /// Queues the writes whose time has come.
  void queue_due(Time now);

  /// See WrittenListener.
  void on_written(const Write& write);
  void on_made_safe(const std::vector<Write>& values);

  /// Cancels those that wait.
  void cancel(const std::string& reason);
  /// Cancels the one with that number. Returns false if there is none, or if it has been sent.
  bool cancel(std::uint32_t number, const std::string& reason);

 private:
  struct Entry final : WriteListener {
    enum class State { waiting, being_written };
    Entry(ScheduledWrites& writes, const AcceptedWrite& accepted) : owner(writes), what(accepted) {}
    void on_result(const WriteResult& result) override { owner.on_result(*this, result); }

    ScheduledWrites& owner;
    AcceptedWrite what;
    State state = State::waiting;
  };

  std::list<Entry>::const_iterator find(std::uint32_t number) const;
  static std::uint32_t point(const Entry& entry) { return entry.what.what.write.point; }
  static Time due(const Entry& entry);
  void find_due();
  /// Cancels those that wait and for which `which(entry)` is true.
  template <class Which>
  void cancel_if(Which which, Stamp at, const std::string& reason);
  Entry* next(Time now);
  void queue(Entry& entry);
  bool is_too_late(const Entry& entry) const;
  void on_result(const Entry& entry, const WriteResult& result);
  void finish(const Entry& entry, ScheduledOutcome::Result result, Stamp at, const std::string& reason);
  void remove(const Entry& entry);

  Link& link_;
  Clock& clock_;
  Writer& writer_;
  ScheduledListener& outcomes_;
  std::list<Entry> entries_;  ///< in the order in which they were accepted
  Time due_ = Time::max();
  bool queueing_ = false;
};

}  // namespace coupler::host
