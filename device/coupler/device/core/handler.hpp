// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>
#include <tl/expected.hpp>

#include "coupler/device/core/changes.hpp"
#include "coupler/device/core/clock.hpp"
#include "coupler/device/core/edge_points.hpp"
#include "coupler/device/core/hardware.hpp"
#include "coupler/device/core/image.hpp"
#include "coupler/device/core/output_schedule.hpp"
#include "coupler/device/core/rights.hpp"
#include "coupler/device/core/statistics.hpp"
#include "coupler/device/core/watchdog.hpp"
#include "coupler/map/field_side.hpp"
#include "coupler/map/identity.hpp"
#include "coupler/modbus/limits.hpp"
#include "coupler/modbus/server.hpp"

namespace coupler::device {

/// The data of a node.
struct NodeState {
  Image& image;  ///< shows outputs as the lines are driven
  Statistics& statistics;
  OutputWatchdog& watchdog;
  Span<EdgePoints::Link> links;  ///< node_memory().links of them
  Changes& changes;
  OutputSchedule& schedule;
};

/// Carries out requests, one at a time and each as a whole: everything is validated, then the hardware is
/// driven, then the image is changed, then the reply is made. What fails leaves no trace. Allocates nothing.
class Handler {
 public:
  /// Map, state and clock outlive the handler. Without a clock times are those at which a turn began.
  Handler(const Map& map, Hardware hardware, const NodeState& state, const Clock* clock = nullptr);

  /// Sets the machine on which the node says that it runs. Until then it says that it does not know.
  void set_machine(const identity::Machine& machine);

  /// From now on clients can schedule outputs and wait for changes (docs/time.md). Whoever calls handle() has
  /// to answer those that wait: see Server. The epoch is not 0, and another one at each start: a random
  /// number. Until then the node says that it does not know these functions.
  void tell_changes(std::uint32_t epoch, TimePoint now);
  const Changes& changes() const { return changes_; }
  /// See Hooks.
  bool answers() const { return hardware_.answers(); }
  Rights rights_of(const ClientSession& session) const { return {map_, session}; }
  /// Returns the role with the name in a TLS client's certificate (empty: none), for ClientSession::role.
  const Role* role_of(std::string_view name) const { return map_.security.role_of(name); }

  /// Answers a request PDU (at least one byte) with a reply PDU in `reply` (at least max_pdu_size bytes);
  /// returns its size; `session` sent it. 0: the session waits for changes now, which it did not before.
  /// Exceptions: those of parse_request(); 01 a point that the client has no right to; 02 an address that is
  /// not mapped, not readable or not writable; 03 a value that does not reset the watchdog, that the map does
  /// not allow, or that an output cannot take; 04 hardware that cannot be read or driven, or an output that
  /// the watchdog keeps in its safe state; 06 no place left to schedule such an output.
  std::size_t handle(modbus::Bytes request, ClientSession& session, TimePoint now, Span<std::uint8_t> reply);
  /// Returns whether there is a field side (coupler/map/field_side.hpp).
  bool has_field_side() const { return hardware_.is_simulated() && map_.connection.unit != field_unit; }
  /// Answers there. It has FC 1 … 6, 15 and 16, feeds no watchdog, and is for clients that may read every
  /// point. Its requests are not counted. Exceptions as handle()'s; 02 also an input that has its value from
  /// elsewhere: a wire, a counter, a firmware's code.
  std::size_t handle_from_field(modbus::Bytes request, ClientSession& session, TimePoint now,
                                Span<std::uint8_t> reply);

  /// Drives the outputs to their safe state if the watchdog is due, drives what is scheduled for now or
  /// before, and takes news if a client asks for changes, unless take_news() did since the last tick.
  /// handle() does so too, first.
  void tick(TimePoint now);
  /// How long tick() need not be called; nullopt: not before the next request.
  std::optional<std::chrono::milliseconds> time_until_due(TimePoint now) const;
  /// When an output, or the end of one, is scheduled next; TimePoint::max(): none is.
  TimePoint next_scheduled() const { return schedule_.earliest(); }

  /// The connection has ended: what it has scheduled is cancelled.
  void end_session(const ClientSession& session, TimePoint now);
  /// This process serves no longer: what is scheduled is cancelled, what has begun goes on.
  void end_schedule(TimePoint now);
  /// Cancels what is scheduled, drives every output to its safe state and ends all durations. False: an
  /// output could not be driven.
  [[nodiscard]] bool make_safe(modbus::Reason reason, TimePoint now);

  /// Takes what came by itself: edges of inputs, values that the firmware has set.
  void take_news(TimePoint now);

 private:
  using Answer = tl::expected<std::size_t, modbus::Exception>;
  /// A request on its way to its answer.
  struct Call {
    modbus::Bytes request;
    ClientSession& session;
    TimePoint now;
    Span<std::uint8_t> reply;
  };

  void take(TimePoint now);
  Answer answer(const Call& call);
  Answer carry_out(const modbus::Read& read, const Call& call);
  Answer carry_out(const modbus::WriteBits& write, const Call& call);
  Answer carry_out(const modbus::WriteRegisters& write, const Call& call);
  Answer carry_out(const modbus::MaskWrite& write, const Call& call);
  Answer carry_out(const modbus::ReadWriteRegisters& both, const Call& call);
  Answer carry_out(const modbus::FileGroups& groups, const Call& call);
  Answer carry_out(const modbus::Echo& echo, const Call& call);
  Answer carry_out(const modbus::ReadDeviceIdentification& wanted, const Call& call);
  Answer carry_out(const modbus::ChangesRequest& request, const Call& call);
  Answer carry_out(const modbus::ScheduleOutput& wanted, const Call& call);
  Answer carry_out(const modbus::CancelOutput& wanted, const Call& call);
  Answer carry_out(const modbus::CancelOutputs& wanted, const Call& call);

  Answer hardware_failed();
  void drive_due(TimePoint now);
  void expire_watchdog(TimePoint now);
  /// Drives what the firmware wants outputs with a line to have. It neither arms nor feeds the watchdog.
  void drive_wanted(TimePoint now);
  bool drive_safe(TimePoint now);
  void show_outputs();
  bool read_hardware(Table table, modbus::Range range, Span<std::uint16_t> cells, TimePoint now);
  /// Though no request asks for them now.
  bool wants_news(TimePoint now) const;

  // Requests that write: handler_writes.cpp.
  /// Whether every output that the watchdog guards may be written.
  bool may_reset_watchdog(const Rights& rights);
  Answer reset_watchdog(const modbus::WriteRegisters& write, const Call& call);
  /// Empty if one is not mapped, not writable, or holds in part a value that is only written as a whole: a
  /// counter's, or that of an analogue output.
  Span<std::uint16_t> writable_registers(modbus::Range range) const;
  /// Returns whether next_ would give a point of the range a value that the map does not allow.
  bool is_forbidden(Table table, modbus::Range written) const;
  bool is_forbidden(const Point& point, modbus::Range written) const;
  void put_next(const modbus::WriteBits& write);
  void put_next(const modbus::WriteRegisters& write);
  /// Drives the outputs of the range, then stores in its cells: what next_ says. A client's write, which
  /// cancels what is scheduled there.
  tl::expected<void, modbus::Exception> store(Table table, modbus::Range range, Span<std::uint16_t> cells,
                                              TimePoint now);
  tl::expected<void, modbus::Exception> drive_and_store(Table table, modbus::Range range,
                                                        Span<std::uint16_t> cells, TimePoint now,
                                                        bool wanted_by_firmware = false);
  /// Pulses of the range that begin with what next_ says, before it is driven: they end all the same if this
  /// process dies meanwhile, and if that fails, for a line may have moved.
  void begin_pulses(modbus::Range coils, TimePoint now);
  /// Notes what was driven: a coil of the range that is 0 has no pulse, and one that is 1 has its whole pulse
  /// ahead, or at most `longest`.
  void follow_pulses(modbus::Range coils, TimePoint now,
                     std::chrono::milliseconds longest = std::chrono::milliseconds::max());
  /// A coil that was 1 when this process, or this map, came into force ends, too.
  void begin_pulses_that_are_missing();

  // The field side: handler_field.cpp.
  Answer answer_from_field(const Call& call);
  Answer read_from_field(const modbus::Read& read, const Call& call);
  bool is_free_input(const Point& point) const;
  /// The inputs of the range get what next_ says.
  Answer set_inputs(Table table, modbus::Range range, const Call& call);

  // Outputs at a time: handler_schedule.cpp.
  bool can_schedule() const;
  Span<std::uint16_t> writable(Table table, modbus::Range range) const;
  tl::expected<void, modbus::Exception> check(const modbus::ScheduleOutput& wanted, Table table,
                                              const ClientSession& session);
  Answer reply_schedule(std::uint16_t number, const Call& call) const;
  void drive_scheduled(TimePoint now);
  void drive(ScheduledOutput& which, TimePoint now);
  void end(ScheduledOutput& which, TimePoint now);
  TimePoint later(TimePoint now) const;

  const Map& map_;
  identity::Machine machine_{};
  Image& image_;
  Hardware hardware_;
  Statistics& statistics_;
  OutputWatchdog& watchdog_;
  Changes& changes_;
  bool took_news_ = false;               ///< take_news() did, since the last tick()
  std::optional<TimePoint> listened_{};  ///< when a client asked for changes, the last time
  EdgePoints edge_points_;
  OutputSchedule& schedule_;
  const Clock* clock_;
  bool shows_identity_;
  bool hears_lines_;                                          ///< a firmware's code does
  bool forbids_values_;                                       ///< the map does, of a point that is written
  bool has_pulses_;                                           ///< the map has
  bool wrote_output_ = false;                                 ///< the request that is being answered has
  std::array<std::uint16_t, modbus::max_write_bits> next_{};  ///< what a write stores, before it is committed
};

}  // namespace coupler::device
