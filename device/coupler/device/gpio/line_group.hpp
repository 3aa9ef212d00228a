// SPDX-License-Identifier: Apache-2.0
// What a backend offers: lines that one call drives or reads together. Levels are logical, 0 or 1.
#pragma once

#include <cerrno>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>

#include "coupler/base/span.hpp"
#include "coupler/device/core/edges.hpp"
#include "coupler/device/core/time.hpp"

namespace coupler::device {

constexpr std::size_t max_group_size = 64;  ///< what one request to the kernel holds

class LineGroup {
 public:
  virtual ~LineGroup() = default;
  /// Returns a text for the log: "gpiochip0 lines 5 (GPIO5), 6 (GPIO6)".
  virtual const std::string& name() const = 0;
  /// False: its chip was unplugged. Asks the kernel, not the chip.
  virtual bool is_plugged() { return true; }
};

class OutputGroup : public LineGroup {
 public:
  /// All lines of the group at once. Returns 0 or an errno; then none of them counts as driven.
  [[nodiscard]] virtual int drive(Span<const int> levels) = 0;
  /// The levels that the lines have, as far as the chip can tell. Returns 0 or an errno.
  [[nodiscard]] virtual int read(Span<int> levels) = 0;
};

/// Receives the events of the lines of a group. `line` is the index of a line in the group.
class LineSink {
 public:
  /// Receives the edges of a line that counters or latched points count.
  virtual void edges(std::size_t line, const Edges& edges) = 0;
  /// See EdgeSink.
  virtual void changed(std::size_t line, bool level, TimePoint at) = 0;
  virtual void lost(std::uint32_t changes) = 0;

 protected:
  ~LineSink() = default;
};

class InputGroup : public LineGroup {
 public:
  /// All lines of the group at once. Returns 0 or an errno.
  [[nodiscard]] virtual int read(Span<int> levels, TimePoint now) = 0;

  /// The descriptor at which the kernel reports edges; -1 if it reports none. The owner of the event loop
  /// watches it.
  virtual int descriptor() const { return -1; }
  /// Takes the waiting edges without blocking.
  virtual void take_edges() {}
  /// False, after take_edges(): none can be taken any more, for the lines are gone (their chip was
  /// unplugged). The descriptor stays readable for ever then, so it must not be watched any more.
  virtual bool reports_edges() const { return true; }
  /// Tells what was taken, or seen by looking at the lines, since the last call.
  virtual void tell(TimePoint, LineSink&) {}
  /// When tell() is to be called again although the descriptor is not ready.
  virtual std::optional<TimePoint> next_change(TimePoint) const { return std::nullopt; }
  /// Lines::has_to_look().
  virtual bool has_to_look() const { return false; }
  /// The level that was told last; before the first change, the one that the line had when it was requested.
  virtual std::optional<bool> level([[maybe_unused]] std::size_t line) const { return std::nullopt; }
};

// Stand-ins for lines whose chip is unplugged.
template <class Group>
class Absent : public Group {
 public:
  explicit Absent(std::string name) : name_(std::move(name)) {}
  const std::string& name() const override { return name_; }
  bool is_plugged() override { return false; }

 private:
  std::string name_;
};

class AbsentOutputs : public Absent<OutputGroup> {
 public:
  using Absent::Absent;
  int drive(Span<const int>) override { return ENODEV; }
  int read(Span<int>) override { return ENODEV; }
};

/// A stand-in for lines whose chip, or its bus, hangs: calls fail at once.
class HungOutputs : public OutputGroup {
 public:
  explicit HungOutputs(std::string name) : name_(std::move(name)) {}
  const std::string& name() const override { return name_; }
  int drive(Span<const int>) override { return ETIMEDOUT; }
  int read(Span<int>) override { return ETIMEDOUT; }

 private:
  std::string name_;
};

class AbsentInputs : public Absent<InputGroup> {
 public:
  using Absent::Absent;
  int read(Span<int>, TimePoint) override { return ENODEV; }
};

}  // namespace coupler::device
