// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>

#include "coupler/device/core/client_session.hpp"
#include "coupler/device/core/time.hpp"
#include "coupler/map/watchdog.hpp"

namespace coupler::device {

/// Tells when the client has been silent for too long. A write to an output arms it; requests of connections
/// that have written one feed it, so neither a monitor nor an HMI that writes something else can keep a dead
/// client's outputs on.
class OutputWatchdog {
 public:
  /// The value that the identity area shows at at_watchdog_state.
  enum class State : std::uint16_t { absent, idle, armed, expired };

  explicit OutputWatchdog(const Watchdog& settings)
      : settings_(settings), state_(settings.present() ? State::idle : State::absent) {}

  State state() const { return state_; }
  bool is_present() const { return state_ != State::absent; }
  /// Outputs cannot be written before reset(): it has expired, and recovery is manual.
  bool is_locked() const {
    return state_ == State::expired && settings_.recovery == Watchdog::Recovery::manual;
  }

  /// A client has written to an output.
  void arm(TimePoint now);
  /// A request of this client was carried out; `wrote_output`: it was a write to an output.
  void request(ClientSession& session, bool wrote_output, TimePoint now);
  /// The operator has seen that it expired.
  void reset();

  /// Something is to be done: expire() is to be called and the outputs are to be driven to their safe state.
  bool is_due(TimePoint now) const { return deadline_ && now >= *deadline_; }
  /// The outputs were driven to their safe state. If that failed, it is due again after another timeout.
  void expire(bool outputs_are_safe, TimePoint now);
  /// They went there for another reason: there is nothing to wait for. What expired stays so.
  void disarm();
  /// Goes on where that of another map was; a wait begins anew.
  void take_over(const OutputWatchdog& before, TimePoint now);
  /// When it is due; nullopt: never, unless somebody writes.
  std::optional<TimePoint> deadline() const { return deadline_; }
  /// Until the outputs go to their safe state, rounded up; 0 unless armed.
  std::chrono::milliseconds left(TimePoint now) const;

 private:
  Watchdog settings_;
  State state_;
  std::optional<TimePoint> deadline_;
};

}  // namespace coupler::device
