// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
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
    if (on_drive) on_drive();
    if (broken || (stuck && coils.contains(*stuck))) return false;
    if (remembers) driven_.emplace_back(coils, std::vector<std::uint16_t>(levels.begin(), levels.end()));
    for (auto& [address, output] : outputs)
      if (coils.contains(address)) output.level = levels[address - coils.start()];
    return true;
  }
  bool are_plugged(modbus::Range) const override { return !unplugged; }
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
    if (on_safe) on_safe();
    if (broken) return false;
    for (auto& [address, output] : outputs)
      if (address != stuck) output.level = output.safe;
    return !stuck;
  }

  bool is_simulated() const override { return simulated; }
  bool pull(modbus::Range inputs, Span<const std::uint16_t> levels) override {
    if (wired && inputs.contains(*wired)) return false;
    for (std::size_t i = 0; i < levels.size(); ++i)
      set_input(static_cast<std::uint16_t>(inputs.start() + i), levels[i]);
    return true;
  }

  void take_edges(TimePoint, EdgeSink& sink) override {
    for (const auto& [input, happened] : edges) sink.add(input, happened);
    edges.clear();
    for (const Change& change : changes) sink.changed(change.input, change.level, change.at);
    changes.clear();
    if (const auto lost = std::exchange(lost_changes, 0); lost != 0) sink.lost(lost);
  }
  std::optional<TimePoint> next_change(TimePoint) const override { return next; }
  bool has_to_look() const override { return looks; }

  void set_input(std::uint16_t address, std::uint16_t level) { inputs_[address] = level; }
  /// What drive() was called with.
  const auto& writes() const { return driven_; }

  struct Change {
    std::uint16_t input = 0;
    bool level = false;
    TimePoint at{};
  };

  std::vector<std::pair<std::uint16_t, Edges>> edges;  ///< not told yet
  std::vector<Change> changes;                         ///< not told yet
  std::uint32_t lost_changes = 0;                      ///< not told yet
  std::optional<TimePoint> next;                       ///< when it wants to be asked again
  bool looks = false;                                  ///< has_to_look()
  bool broken = false;
  std::optional<std::uint16_t> stuck;  ///< this output cannot be driven
  bool unplugged = false;              ///< and known to be
  bool remembers = true;
  bool simulated = false;
  std::optional<std::uint16_t> wired;  ///< this input, to an output
  int safe_calls = 0;
  std::function<void()> on_drive;           ///< is called when they are about to be driven
  std::function<void()> on_safe;            ///< is called when they are about to be driven to it
  std::map<std::uint16_t, Output> outputs;  ///< the coils that have a line

 private:
  std::vector<std::pair<modbus::Range, std::vector<std::uint16_t>>> driven_;
  std::map<std::uint16_t, std::uint16_t> inputs_;
};

}  // namespace coupler::device
