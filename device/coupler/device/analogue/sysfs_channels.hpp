// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <deque>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "coupler/device/analogue/iio.hpp"
#include "coupler/device/analogue/latest.hpp"
#include "coupler/device/analogue/pwm.hpp"
#include "coupler/device/core/channels.hpp"
#include "coupler/device/core/log.hpp"
#include "coupler/device/gpio/fault.hpp"
#include "coupler/device/supervisor/shared_array.hpp"

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
    explicit Sampled(WiredInput input) : wired(std::move(input)) {}
    WiredInput wired;
    Latest latest;
  };

  /// `sysfs` is where they were found.
  SysfsChannels(std::string sysfs, std::vector<WiredInput> inputs, std::vector<WiredOutput> outputs,
                Log& log);

  std::optional<double> read(const Point& input, TimePoint now) override;
  bool accepts(const Point& output, double value) const override;
  Outcome drive(const Point& output, double value) override;

  /// Drives outputs that its successor (may be null) does not have to their safe state.
  void hand_over(const SysfsChannels* successor);

  /// Finds channels again whose device was unplugged and is back; tells which. Processes that were forked
  /// before do not know of it.
  std::vector<const Point*> mend();

  std::deque<Sampled>& inputs() { return inputs_; }

 private:
  std::size_t index_of(const Point& output) const;

  std::string sysfs_;
  SharedArray<int> errors_;  ///< the last of each input, then of each output
  std::deque<Sampled> inputs_;
  std::vector<WiredOutput> outputs_;
  std::vector<Fault> faults_;  ///< as errors_
};

}  // namespace coupler::device
