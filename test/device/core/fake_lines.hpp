// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <utility>
#include <vector>

#include "coupler/device/core/lines.hpp"

namespace coupler::device {

/// Hardware that remembers how it was driven and fails when told to.
class FakeLines : public Lines {
 public:
  struct Output {
    std::uint16_t safe = 0;
    std::uint16_t level = 0;
  };

  bool read(modbus::Range inputs, Span<std::uint16_t> levels, TimePoint) override {
    for (const auto& [address, level] : inputs_)
      if (inputs.contains(address)) levels[address - inputs.start()] = level;
    return !broken;
  }
  bool drive(modbus::Range coils, Span<const std::uint16_t> levels) override {
    if (broken) return false;
    if (remembers) driven_.emplace_back(coils, std::vector<std::uint16_t>(levels.begin(), levels.end()));
    for (auto& [address, output] : outputs)
      if (coils.contains(address)) output.level = levels[address - coils.start()];
    return true;
  }
  bool driven(modbus::Range coils, Span<std::uint16_t> levels) const override {
    bool any = false;
    for (const auto& [address, output] : outputs) {
      if (!coils.contains(address)) continue;
      levels[address - coils.start()] = output.level;
      any = true;
    }
    return any;
  }
  bool drive_safe() override {
    ++safe_calls;
    if (broken) return false;
    for (auto& [address, output] : outputs) output.level = output.safe;
    return true;
  }

  void take_edges(TimePoint, EdgeSink& sink) override {
    for (const auto& [input, happened] : edges) sink.add(input, happened);
    edges.clear();
  }

  void set_input(std::uint16_t address, std::uint16_t level) { inputs_[address] = level; }
  /// What drive() was called with.
  const auto& writes() const { return driven_; }

  std::vector<std::pair<std::uint16_t, Edges>> edges;  ///< not told yet
  bool broken = false;
  bool remembers = true;
  int safe_calls = 0;
  std::map<std::uint16_t, Output> outputs;  ///< the coils that have a line

 private:
  std::vector<std::pair<modbus::Range, std::vector<std::uint16_t>>> driven_;
  std::map<std::uint16_t, std::uint16_t> inputs_;
};

}  // namespace coupler::device
