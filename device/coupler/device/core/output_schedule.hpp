// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>

#include "coupler/base/span.hpp"
#include "coupler/device/core/time.hpp"
#include "coupler/map/table.hpp"
#include "coupler/modbus/changes.hpp"
#include "coupler/modbus/scheduled_output.hpp"

namespace coupler::device {

struct ClientSession;

/// Receives the outcomes of scheduled outputs.
class ScheduleSink {
 public:
  /// The kind is done, cancelled or failed. `owner` scheduled it.
  virtual void add_outcome(const modbus::Change& outcome, const ClientSession* owner) = 0;

 protected:
  ~ScheduleSink() = default;
};

/// An output that is driven at a time, and one that was driven for a duration or a pulse: it has begun.
struct ScheduledOutput {
  enum class State : std::uint8_t { free, waiting, begun };

  /// Says whether the outputs had to go to their safe state since this one began.
  enum class Safety : std::uint8_t { unasked, reached, failed };

  State state = State::free;
  Safety safety = Safety::unasked;
  bool is_overdue = false;  ///< it could not end in time
  std::uint16_t number = 0;
  Table table = Table::coils;
  modbus::Range range = modbus::Range::of(0, 1);
  TimePoint at{};  ///< when it is due; of one that has begun, when it ends
  std::chrono::milliseconds duration{};
  std::uint64_t order = 0;  ///< in which they were accepted; of those that have begun, in which they did
  const ClientSession* owner = nullptr;  ///< whose it is, until its outcome is told
  /// The values that the outputs are driven to, or, once it has begun, the values from before. They are as on
  /// the wire.
  std::array<std::uint8_t, std::size_t{2} * modbus::max_scheduled_registers> packed{};

  std::uint16_t value(std::size_t i) const;
  void set_value(std::size_t i, std::uint16_t value);
};

/// The outputs that clients have scheduled, and the pulses that run (Point::pulse), in a fixed number of
/// places. It decides what is due and what is cancelled; its callers drive the outputs. The places may be in
/// memory that outlives the process. Then outputs that have begun go on in the next process.
class OutputSchedule {
 public:
  /// Those that wait in `places` are dropped: their clients are gone. `sink` may be null. Both outlive it.
  /// The last `pulses` places are for pulses: NodeMemory's number of them.
  explicit OutputSchedule(Span<ScheduledOutput> places, ScheduleSink* sink = nullptr, std::size_t pulses = 0);

  /// False: there are no places for what clients schedule.
  bool is_present() const { return places_.size() > pulses_.size(); }

  /// Durations that are longer get half of the places at most: a client that takes them and leaves does not
  /// shut out the others for an hour.
  static constexpr std::chrono::minutes longest_short{1};

  /// Null: every place of clients is taken, or every one for such a duration.
  ScheduledOutput* add(const modbus::ScheduleOutput& wanted, Table table, TimePoint due,
                       const ClientSession& owner);

  /// Returns the entry that is due or ends next; null if there is none until then. At the same time ends come
  /// first, and then entries in the order in which they were accepted.
  ScheduledOutput* due(TimePoint now);
  /// The time at which the next of all entries is due or ends; TimePoint::max() if there is none.
  TimePoint earliest() const { return earliest_; }

  /// It is about to be driven until `end`: keeps the values from before, one for each address. If this
  /// process dies while it is driven, it ends all the same.
  void begin(ScheduledOutput& which, TimePoint end, Span<const std::uint16_t> before);
  /// The coil is 1, or is about to be driven to it, until `end`: its pulse begins, or goes on for longer.
  void pulse(std::uint16_t coil, TimePoint end);
  /// The coil is 0.
  void end_pulse(std::uint16_t coil);
  bool has_pulse(std::uint16_t coil) { return pulse_of(coil) != nullptr; }
  /// Ends at another time.
  void postpone(ScheduledOutput& which, TimePoint end);
  /// It could not be ended, and is due again at this time.
  void retry(ScheduledOutput& which, TimePoint again);
  /// Its place is free.
  void remove(ScheduledOutput& which);

  void tell_done(const ScheduledOutput& which, TimePoint at);
  void tell_failed(const ScheduledOutput& which, modbus::Reason reason, TimePoint at);

  // Each of these cancels what has not begun. `at` is when.
  /// False: the client has no such one.
  bool cancel(std::uint16_t number, const ClientSession& owner, TimePoint at);
  /// Those of the client that overlap the range and are due at `from` or later. Returns how many there were.
  std::size_t cancel_from(TimePoint from, Table table, modbus::Range range, const ClientSession& owner,
                          TimePoint at);
  void cancel_of(const ClientSession& owner, TimePoint at);
  void cancel_overlapping(Table table, modbus::Range written, TimePoint at);
  void cancel_all(modbus::Reason reason, TimePoint at);

  /// The outputs have gone to their safe state: what has begun does not bring them out of it. False: not all
  /// of them could be driven there, or are not yet. Then they go there at its end. What could not end in time
  /// is due at once.
  void outputs_went_safe(bool all, TimePoint now);
  /// Outputs were driven to this: what could not end in time does not bring them back any more.
  void driven(Table table, modbus::Range range, Span<const std::uint16_t> cells);

  /// The one that began next after `which` and has the address; null: none.
  ScheduledOutput* begun_after(const ScheduledOutput& which, std::uint32_t address);
  /// Calls `use`, which may remove it, with each that has begun, in the order in which they did.
  template <class Use>
  void each_begun(Use use) {
    for (ScheduledOutput* one = first_begun(0); one != nullptr;) {
      const std::uint64_t order = one->order;
      use(*one);
      one = first_begun(order + 1);
    }
  }

 private:
  template <class Which>
  void cancel_if(modbus::Reason reason, TimePoint at, Which which);
  void tell(const ScheduledOutput& which, modbus::Change::Kind kind, modbus::Reason reason, TimePoint at);
  ScheduledOutput* first_begun(std::uint64_t order);
  bool are_overdue_after(const ScheduledOutput& which, std::uint32_t address);
  ScheduledOutput* pulse_of(std::uint16_t coil);
  bool has_room_for(std::chrono::milliseconds duration) const;
  std::uint16_t unused_number();
  void find_earliest();

  Span<ScheduledOutput> places_;
  Span<ScheduledOutput> pulses_;  ///< the last of them
  ScheduleSink* sink_;
  std::size_t waiting_ = 0;
  bool any_overdue_ = false;  ///< there was one
  std::uint16_t last_number_ = 0;
  std::uint64_t last_order_ = 0;
  TimePoint earliest_ = TimePoint::max();
};

}  // namespace coupler::device
