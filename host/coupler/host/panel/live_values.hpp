// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <condition_variable>
#include <cstdint>
#include <functional>
#include <mutex>
#include <string>
#include <vector>

#include "coupler/host/core/device_statistics.hpp"
#include "coupler/host/core/point_quality.hpp"
#include "coupler/host/core/sink.hpp"
#include "coupler/host/panel/history.hpp"
#include "coupler/map/map.hpp"

namespace coupler::host {

/// The data that a page shows of a device: the last value of each point, with its quality and its last ten
/// minutes. The connection's thread adds values. Pages wait for news, each at its own pace.
class LiveValues : public Sink {
 public:
  using Report = std::function<void(Level, const std::string&)>;
  /// The storage of `map` must outlive it.
  LiveValues(const Map& map, Report report);

  void on_bits(const ReadSpan& span, Span<const std::uint8_t> bits, Stamp stamp) override;
  void on_registers(const ReadSpan& span, Span<const std::uint16_t> registers, Stamp stamp) override;
  void on_online(bool online) override;
  void on_loss(const std::string& why) override;
  void on_report(Level level, const std::string& text) override { report_(level, text); }
  /// The device's qualities have changed.
  void judge(const std::vector<PointQuality>& qualities, Time now);
  /// Nobody reads any more: nothing is known.
  void stopped();

  /// How the device is. To be told about once a second.
  void tell(const DeviceSnapshot& device);

  /// Waits for something newer than `seen`, not beyond `until`, but until `earliest` at least; then `seen` is
  /// what is told. One JSON object: the points that are newer, by name, and the device. Everything, with
  /// `seen` 0.
  std::string news(std::uint64_t& seen, Time earliest, Time until);
  /// The last steps of all points' ten minutes: by name, a list of [least, greatest] or null. JSON.
  std::string histories(Time now, std::size_t steps = History::steps);
  /// A loop check: which points were seen on and off, or with more than one value, since the start. CSV (RFC
  /// 4180).
  std::string seen_csv();
  /// Ends every wait.
  void end();

 private:
  struct State {
    std::vector<std::uint16_t> registers;  ///< empty: not read yet
    PointQuality::State quality = PointQuality::State::never_read;
    unsigned exception = 0;
    std::string why;             ///< in place of an exception
    Time changed_at{};           ///< when it became another one
    std::uint64_t revision = 1;  ///< of the last change that a page is to see
    std::uint64_t changes = 0;   ///< since the first value
    bool seen_on = false;        ///< or another value than 0
    bool seen_off = false;       ///< or 0
    History history;
  };
  template <class Element>
  void take(const ReadSpan& span, Span<const Element> values, Stamp stamp);
  void take_number(const Point& point, State& state, Time at);

  const Map map_;
  const Report report_;
  std::mutex mutex_;
  std::condition_variable news_;
  std::vector<State> points_;
  std::vector<std::uint16_t> next_;
  std::uint64_t revision_ = 1;
  std::uint64_t device_revision_ = 1;
  bool online_ = false;
  bool ended_ = false;
  std::uint64_t requests_ = 0;
  std::uint64_t errors_ = 0;  ///< of them
  Duration round_trip_{};     ///< of most requests
  std::string why_offline_;
};

}  // namespace coupler::host
