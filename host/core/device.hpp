// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <string>

#include "common/modbus/limits.hpp"
#include "host/core/backoff.hpp"
#include "host/core/identity_check.hpp"
#include "host/core/paced_transport.hpp"
#include "host/core/poll_cycle.hpp"
#include "host/core/sink.hpp"
#include "host/core/write_queue.hpp"

namespace coupler::driver {

/// One coupler: connects and comes back by itself, proves that both sides have the same map, writes first and
/// reads on schedule. It has no thread of its own: step() is called again and again by one.
///
/// A device whose map differs is left alone under Verify::require: nothing is written, and nothing is read
/// either, since a value from a place that now means something else would be published under the old name.
/// The connection is closed (it may be the only one the device has) and the identity is asked for again after
/// the back-off.
class Device {
 public:
  /// `map`'s views, and everything given by reference, must outlive the device.
  Device(const Map& map, Verify verify, MapLoader load, Transport& transport, Clock& clock,
         WriteQueue& writes, Sink& sink);

  /// Does what is due, at most one read or one write, and returns the time of what is due next: now or
  /// earlier if there is more to do. A write in the queue is always due while connected.
  Time step();

  /// The program ends: drops the connection without trying again.
  void stop();

  std::uint64_t overruns() const { return cycle_.overruns(); }

 private:
  Time connect();
  Result<> prove_equal();
  Result<> judge(const Identity& identity);
  void explain_silence(const Error& error);
  void write(const Write& write);
  void drop_writes();
  void read();
  void rejected_read(modbus::Exception code);
  void handle_read_error(const Error& error);
  void came_online();
  void lost(const Error& error);
  std::string describe(const ReadSpan& span) const;

  Map map_;
  Verify verify_;
  MapLoader load_;
  PacedTransport transport_;
  Clock& clock_;
  WriteQueue& writes_;
  Sink& sink_;
  PollCycle cycle_;
  Backoff backoff_;

  bool connected_ = false;  ///< proven equal; reads and writes may go out
  bool online_ = false;     ///< connected, and the device has answered
  Time retry_at_ = Time::min();
  std::string last_trouble_;               ///< why the last attempt failed, so that it is told once
  bool silence_told_ = false;              ///< that the identity was not answered, and the remedy
  std::uint64_t refused_fingerprint_ = 0;  ///< whose differences have been told
  std::uint64_t dropped_writes_ = 0;       ///< since the connection was lost
  std::array<std::uint8_t, modbus::max_read_bits> bits_{};
  std::array<std::uint16_t, modbus::max_read_registers> registers_{};
};

}  // namespace coupler::driver
