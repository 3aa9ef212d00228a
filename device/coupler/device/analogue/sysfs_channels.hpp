// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <tl/expected.hpp>
#include <utility>
#include <variant>
#include <vector>

#include "coupler/device/analogue/iio.hpp"
#include "coupler/device/analogue/latest_sample.hpp"
#include "coupler/device/analogue/pwm.hpp"
#include "coupler/device/core/channels.hpp"
#include "coupler/device/core/log.hpp"
#include "coupler/device/core/time.hpp"
#include "coupler/device/gpio/fault.hpp"
#include "coupler/device/supervisor/shared_memory.hpp"
#include "coupler/map/map.hpp"

namespace coupler::device {

struct WiredInput {
  const Point* point;
  IioInput channel;
};

struct WiredOutput {
  const Point* point;
  std::variant<IioOutput, PwmOutput> channel;
};

bool accepts(const WiredOutput& output, double value);
const std::string& name_of(const WiredOutput& output);

/// The channels of a map, which a Sampler reads. Processes forked from this one use the same.
class SysfsChannels : public Channels {
 public:
  /// An input and its newest sample.
  struct Sampled {
    Sampled(WiredInput input, Fault its) : wired(std::move(input)), fault(std::move(its)) {}
    WiredInput wired;
    Fault fault;
    LatestSample latest;
  };

  /// `sysfs` is where they were found.
  SysfsChannels(std::string sysfs, std::vector<WiredInput> inputs, std::vector<WiredOutput> outputs,
                Log& log);

  std::optional<double> read(const Point& input, TimePoint now) override;
  bool accepts(const Point& output, double value) const override;
  bool is_plugged(const Point& output) const override;
  Outcome drive(const Point& output, double value) override;

  /// Its hardware hangs: in this process, what needs the output fails from now on.
  void give_up(const Point& output);

  /// Drives outputs that `successor` (may be null) does not have to their safe state.
  void hand_over(const SysfsChannels* successor);

  /// Opens channels again whose device was unplugged and is plugged in again; returns their points. Waits for
  /// nothing. Processes that were forked before still have the old ones.
  std::vector<const Point*> reconnect();

  std::deque<Sampled>& inputs() { return inputs_; }

 private:
  struct Driven {
    WiredOutput wired;
    Fault fault;
    bool is_given_up = false;
  };

  std::string sysfs_;
  SharedArray<int> errors_;  ///< of the faults
  std::deque<Sampled> inputs_;
  std::vector<Driven> outputs_;
};

/// How long all new PWM channels of a map together may wait for udev: nobody else is attended to meanwhile.
constexpr std::chrono::milliseconds udev_timeout{800};
/// The same while nothing is served yet, as when a board starts and udev is busy.
constexpr std::chrono::milliseconds first_udev_timeout{5000};

/// The channels behind the map's registers, with outputs as they are; null if it has none. The error says for
/// each channel that cannot be opened what there is instead, and what to do; it may have several lines. `map`
/// and `log` outlive the result.
tl::expected<std::unique_ptr<SysfsChannels>, std::string> open_channels(
    const Map& map, Log& log, const std::string& sysfs = "/sys",
    std::chrono::milliseconds timeout = first_udev_timeout);

}  // namespace coupler::device
