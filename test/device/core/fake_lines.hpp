// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <utility>
#include <vector>

#include "device/core/lines.hpp"

namespace coupler::node {

/// Hardware that remembers how it was driven and fails when told to.
class FakeLines : public Lines {
 public:
  bool read(modbus::Range inputs, Span<std::uint16_t> levels, TimePoint) override {
    for (const auto& [address, level] : inputs_)
      if (inputs.contains(address)) levels[address - inputs.start()] = level;
    return !broken;
  }
  bool drive(modbus::Range coils, Span<const std::uint16_t> levels) override {
    if (broken) return false;
    if (remembers) driven.emplace_back(coils, std::vector<std::uint16_t>(levels.begin(), levels.end()));
    return true;
  }
  bool drive_safe() override { return !broken; }

  void set_input(std::uint16_t address, std::uint16_t level) { inputs_[address] = level; }

  bool broken = false;
  bool remembers = true;
  std::vector<std::pair<modbus::Range, std::vector<std::uint16_t>>> driven;

 private:
  std::map<std::uint16_t, std::uint16_t> inputs_;
};

}  // namespace coupler::node
