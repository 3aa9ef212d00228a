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
#include "coupler/host/core/value_table.hpp"
#include "coupler/host/core/wall_time.hpp"
#include "coupler/host/record/record_format.hpp"
#include "coupler/map/map.hpp"

namespace coupler::host {

/// Makes the lines of a recording of what a device gives its sink. The connection's thread calls what is
/// Sink's; another one takes the lines, and writes them, which may take its time.
class Recorder : public Sink {
 public:
  using Report = std::function<void(Level, const std::string&)>;

  /// `values` is the device's table. The table, `format` and the storage of `map` must outlive the
  /// recorder. Times are counted from `start`. `report` is called in the device's thread with what the
  /// device reports.
  Recorder(const Map& map, const ValueTable& values, std::string device, const RecordFormat& format,
           Time start, Report report);

  void on_values(Span<const std::uint32_t> points) override;
  void on_no_values(Span<const std::uint32_t> points, Time at) override;
  void on_identified(Identity::Verdict verdict) override;
  void on_online(bool online) override;
  void on_loss(const std::string& why) override;
  void on_report(Level level, const std::string& text) override { report_(level, text); }
  /// From any thread: who reads is about to end, and a connection that is lost from now on is not the
  /// device's fault.
  void end_comes();

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
  /// The last line of a point.
  struct Line {
    PointQuality::State quality = PointQuality::State::never_read;
    unsigned exception = 0;
    std::uint64_t number = 0;  ///< of its value, see ValueTable
  };
  void queue_unusable(std::uint32_t point);
  void queue_exception(std::uint32_t point, Time at);
  record::Moment moment(Time at) const;
  void queue(const std::string& line);
  std::string line_of(std::uint32_t point, Time now);
  std::string device_line(record::Moment at) const;
  Taken take_now(Time now);
  std::string all_lines(Time now);

  const Map map_;
  const ValueTable& values_;
  const RecordFormat& format_;
  const Time start_;
  const Report report_;
  record::Head head_;

  mutable std::mutex mutex_;
  WallTime wall_;
  std::vector<Line> lines_;  ///< by point
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
