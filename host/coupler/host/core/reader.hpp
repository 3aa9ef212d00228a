// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <string>

#include "coupler/host/core/device_statistics.hpp"
#include "coupler/host/core/paced_transport.hpp"
#include "coupler/host/core/point_quality.hpp"
#include "coupler/host/core/poll_cycle.hpp"
#include "coupler/host/core/sink.hpp"
#include "coupler/host/core/writer.hpp"
#include "coupler/modbus/limits.hpp"

namespace coupler::host {

/// What reads one device: makes the requests of the polling cycle and hands on the values.
///
/// A value that was asked for before a newer one was written is not handed on: the old one would flicker
/// back.
class Reader {
 public:
  /// What `map` views, and everything given by reference, must outlive it.
  Reader(const Map& map, Transport& transport, Clock& clock, Writer& writer, DeviceStatistics& statistics,
         PointQualities& qualities, Sink& sink);

  /// A new connection.
  void start();
  /// When step() has something to do.
  Time due() const { return cycle_.due(); }
  /// A cycle should have been over for a whole period of its rate, and has not begun, or not ended.
  bool is_overdue(Time now) const { return cycle_.is_overdue(now); }
  /// Whether step() would make a request now.
  bool has_request(Time now) { return cycle_.select(now) != nullptr; }
  /// Makes the request that is due, if there is one and its turn comes before `until`. An error means that
  /// the connection is of no more use, or that the unit is away; any other exception is none.
  Result<> step(Time until = Time::max());

  void want(std::uint32_t point, bool wanted) { cycle_.want(point, wanted); }

 private:
  Result<> request(const ReadSpan& span);
  void publish(const ReadSpan& span);
  const ReadSpan& without_hidden(const ReadSpan& span);
  void refused(modbus::Exception code);
  void report_refusals();
  std::string describe(const ReadSpan& span) const;

  Map map_;
  Transport& transport_;
  Clock& clock_;
  Writer& writer_;
  DeviceStatistics& statistics_;
  PointQualities& qualities_;
  Sink& sink_;
  PollCycle cycle_;
  ReadSpan rest_{Table::coils, modbus::Range::of(0, 1), {}};  ///< kept for its memory
  std::array<std::uint8_t, modbus::max_read_bits> bits_{};
  std::array<std::uint16_t, modbus::max_read_registers> registers_{};
};

}  // namespace coupler::host
