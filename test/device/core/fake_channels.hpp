// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <set>
#include <utility>
#include <vector>

#include "coupler/device/core/channels.hpp"

namespace coupler::device {

/// Channels that remember how they were driven and fail when told to. All by the addresses of their points.
class FakeChannels : public Channels {
 public:
  std::optional<double> read(const Point& input, TimePoint) override {
    const auto found = inputs.find(input.address);
    return found == inputs.end() ? std::nullopt : std::optional(found->second);
  }
  bool accepts(const Point&, double value) const override { return value >= least && value <= most; }
  bool is_plugged(const Point& output) const override { return gone.count(output.address) == 0; }
  Outcome drive(const Point& output, double value) override {
    driven.emplace_back(output.address, value);
    if (broken.count(output.address) != 0) return Outcome::failed;
    if (unplugged.count(output.address) != 0) return Outcome::absent;
    if (picky.count(output.address) != 0) return Outcome::refused;
    outputs[output.address] = value;
    return Outcome::done;
  }

  std::map<std::uint16_t, double> inputs;                ///< the others cannot be read
  std::map<std::uint16_t, double> outputs;               ///< as they are driven
  std::vector<std::pair<std::uint16_t, double>> driven;  ///< each call of drive()
  std::set<std::uint16_t> broken;
  std::set<std::uint16_t> unplugged;
  std::set<std::uint16_t> gone;   ///< unplugged, and known to be
  std::set<std::uint16_t> picky;  ///< refuse every value when it is tried
  double least = 0;
  double most = 100;
};

}  // namespace coupler::device
