// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "coupler/device/gpio/inventory.hpp"
#include "coupler/device/gpio/line_group.hpp"
#include "coupler/device/gpio/watched_line.hpp"

namespace coupler::device {

/// Inputs of which every change is told. What is known of them is shared: a process that is started anew
/// takes no edge twice, and no edge that it did not see for a lost one.
class WatchedInputs : public InputGroup {
 public:
  void tell(TimePoint now, LineSink& sink) override;
  std::optional<TimePoint> next_change(TimePoint now) const override;
  std::optional<bool> level(std::size_t line) const override { return lines_[line].level(); }

 protected:
  /// `levels`: those of the lines now, 0 or 1.
  WatchedInputs(const std::vector<LineSpec>& lines, Span<const int> levels);

  std::size_t size() const { return lines_.all().size(); }
  void edge(std::size_t line, bool rising, TimePoint at) { lines_[line].edge(rising, at, changes_); }
  void lose(std::size_t line, std::uint32_t count) { lines_[line].lose(count, changes_); }
  /// The line had this level now, and all reported edges have been taken.
  void look(std::size_t line, bool level, TimePoint now) { lines_[line].look(level, now, changes_); }
  /// The same of a line whose edges are reported.
  void check(std::size_t line, bool level, TimePoint now) { lines_[line].check(level, now, changes_); }
  /// Returns whether the line has to be checked again now.
  bool is_doubtful(std::size_t line, TimePoint now) const {
    const auto due = lines_[line].doubt_due();
    return due && now >= *due;
  }
  bool has_doubts() const;
  /// The line could not be looked at, and is tried again soon. Who waits for changes is told, once, of one
  /// that was lost: it reads everything then, and so hears of it.
  void fail(std::size_t line, int error, TimePoint now) {
    if (lines_[line].fail(error, now)) changes_.lose(1);
  }
  void fail_all(int error, TimePoint now);
  /// 0, or why a line could not be looked at the last time.
  int error() const;
  /// The levels that count now.
  void put_levels(Span<int> levels, TimePoint now);

 private:
  void settle(TimePoint now);

  ChangeQueue changes_;
  SharedArray<WatchedLine> lines_;
};

/// Inputs whose edges the kernel cannot report: they are looked at, some hundred times a second. Changes have
/// the time at which they were seen, and shorter ones are not seen.
class SampledInputs : public WatchedInputs {
 public:
  static constexpr std::chrono::milliseconds period{5};

  SampledInputs(std::unique_ptr<InputGroup> inputs, const std::vector<LineSpec>& lines, TimePoint now);

  const std::string& name() const override { return inputs_->name(); }
  bool is_plugged() override { return inputs_->is_plugged(); }
  int read(Span<int> levels, TimePoint now) override;
  void tell(TimePoint now, LineSink& sink) override;
  std::optional<TimePoint> next_change(TimePoint now) const override;
  bool has_to_look() const override { return is_debounced_; }

 private:
  std::unique_ptr<InputGroup> inputs_;
  TimePoint next_;
  bool is_debounced_;
};

}  // namespace coupler::device
