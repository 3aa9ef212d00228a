// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <condition_variable>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "coupler/host/core/device_statistics.hpp"
#include "coupler/host/core/point_quality.hpp"
#include "coupler/host/core/sink.hpp"
#include "coupler/host/core/value_table.hpp"
#include "coupler/host/panel/history.hpp"
#include "coupler/host/panel/word_bits.hpp"
#include "coupler/map/map.hpp"

namespace coupler::host {

/// The data that a page shows of a device: the last value of each point, from the device's table, with its
/// quality, its changes and its last ten minutes. Pages wait for news, each at its own pace.
class LiveValues : public Sink {
 public:
  using Report = std::function<void(Level, const std::string&)>;
  /// The storage of `map`, and the device's table, must outlive it.
  LiveValues(const Map& map, const ValueTable& table, Report report);

  void on_values(Span<const std::uint32_t> points) override;
  void on_no_values(Span<const std::uint32_t> points, Time at) override;
  void on_online(bool online) override;
  void on_loss(const std::string& why) override;
  void on_report(Level level, const std::string& text) override { report_(level, text); }
  /// Nobody reads any more: nothing is known.
  void stopped();

  /// How the device is. To be told about once a second.
  void tell(const DeviceSnapshot& device);

  /// Waits for something newer than `seen`, not beyond `until`, but until `earliest` at least; then `seen` is
  /// what is told. One JSON object: the points that are newer, by name, and the device. Everything, with
  /// `seen` 0.
  std::string news(std::uint64_t& seen, Time earliest, Time until);
  /// The last steps of all points' ten minutes: by name, a list of [least, greatest] or null; by name with
  /// ".bits", the bits of a word that were on and that were off, as a list of ["on", "off"] or null. JSON.
  std::string histories(Time now, std::size_t steps = History::steps);
  /// A loop check: which points, and bits of words, were seen on and off, or with more than one value, since
  /// the start. CSV (RFC 4180).
  std::string seen_csv();
  /// Ends every wait.
  void end();

 private:
  struct State {
    PointQuality::State quality = PointQuality::State::never_read;
    unsigned exception = 0;
    std::string why;                    ///< the reason if there was no exception
    Time changed_at{};                  ///< the time of the last change of the value
    std::uint64_t revision = 1;         ///< the revision of the last change that a page is to see
    std::uint64_t number = 0;           ///< see ValueTable::number(); 0 if there is no value
    std::uint64_t unusable_number = 0;  ///< the same when the point was refused or unusable last
    bool seen_on = false;               ///< the point was on, or not 0, at least once
    bool seen_off = false;              ///< the point was off, or 0, at least once
    History history;
    std::unique_ptr<WordBits> bits{};  ///< null: the point has none to show

    void lose(Time at) {
      history.lose(at);
      if (bits) bits->lose(at);
    }
  };
  /// Since the first value.
  static std::uint64_t changes_of(const State& state) { return state.number > 0 ? state.number - 1 : 0; }
  void take_number(std::uint32_t point, Time at);
  bool take_quality(std::uint32_t point, const PointQuality& quality, Time at);
  void take_qualities(Time now);

  const Map map_;
  const ValueTable& table_;
  const Report report_;
  std::mutex mutex_;
  std::condition_variable news_;
  std::vector<State> points_;
  Time stale_from_ = Time::max();  ///< the first of the good points becomes stale, if nothing new comes
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
