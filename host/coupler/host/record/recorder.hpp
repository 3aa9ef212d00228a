// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "coupler/host/core/point_quality.hpp"
#include "coupler/host/core/sink.hpp"
#include "coupler/host/core/wall_time.hpp"
#include "coupler/host/record/record_format.hpp"
#include "coupler/map/map.hpp"

namespace coupler::host {

/// Makes the lines of a recording of what a device gives its sink. The connection's thread calls what is
/// Sink's; another one takes the lines, and writes them, which may take its time.
class Recorder : public Sink {
 public:
  using Report = std::function<void(Level, const std::string&)>;

  /// The storage of `map`, and `format`, must outlive it. Time begins at `start`. `report` receives what the
  /// device reports, in its thread.
  Recorder(const Map& map, std::string device, const RecordFormat& format, Time start, Report report);

  void on_bits(const ReadSpan& span, Span<const std::uint8_t> bits, Stamp stamp) override;
  void on_registers(const ReadSpan& span, Span<const std::uint16_t> registers, Stamp stamp) override;
  void on_identified(bool is_node) override;
  void on_online(bool online) override;
  void on_loss(const std::string& why) override;
  void on_report(Level level, const std::string& text) override { report_(level, text); }
  /// From any thread: who reads is about to end, and a connection that is lost from now on is not the
  /// device's fault.
  void end_comes();
  /// The device's qualities have changed; they are those at `now`. From any thread.
  void judge(const std::vector<PointQuality>& qualities, Time now);

  /// The lines since the last call, in the order in which they were learnt. Those of longest_queue bytes at
  /// most: `lost` says that there were more, and all_values() is to follow.
  struct Taken {
    std::string lines;
    bool lost = false;
  };
  Taken take(Time now);
  /// The lines with which a file begins: its head, and all_values().
  std::string beginning(Time now);
  /// Returns the lines about what is known now of every point.
  std::string all_values(Time now);
  /// take() and beginning() at one moment, so that no change is in both.
  struct Turn {
    Taken before;
    std::string beginning;
  };
  Turn turn(Time now);
  std::string missing(Time now, Time since, std::string_view why);
  std::string end(Time now);

  struct Counts {
    std::uint64_t changes = 0;
    std::size_t good = 0;  ///< points with a value
    bool online = false;
    bool was_online = false;
  };
  Counts counts() const;

  static constexpr std::size_t longest_queue = std::size_t{16} << 20;

 private:
  struct State {
    std::vector<std::uint16_t> registers;  ///< empty: not read yet
    PointQuality::State quality = PointQuality::State::never_read;
    unsigned exception = 0;
    Duration uncertainty{};
    Time read_at = Time::min();
  };
  template <class Element>
  void take_values(const ReadSpan& span, Span<const Element> values, Stamp stamp);
  record::Moment moment(Time at) const;
  void queue(const std::string& line);
  std::string line_of(std::uint32_t point, record::Moment at) const;
  std::string device_line(record::Moment at) const;
  Taken take_now(Time now);
  std::string all_values(record::Moment at) const;

  const Map map_;
  const RecordFormat& format_;
  const Time start_;
  const Report report_;
  record::Head head_;

  mutable std::mutex mutex_;
  WallTime wall_;
  std::vector<State> points_;
  std::vector<std::uint16_t> next_;  ///< kept for its memory
  std::string queued_;
  bool lost_ = false;  ///< there was no room in the queue
  bool online_ = false;
  bool ends_ = false;
  bool awaits_reason_ = true;  ///< why it is offline
  std::string why_offline_ = "not connected yet";
  std::optional<bool> is_node_;
  Counts counts_;
};

}  // namespace coupler::host
