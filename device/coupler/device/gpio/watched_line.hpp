// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>

#include "coupler/device/core/time.hpp"
#include "coupler/device/gpio/line_edges.hpp"
#include "coupler/device/supervisor/shared_memory.hpp"
#include "coupler/map/hardware.hpp"

namespace coupler::device {

/// Changes of a group's lines until they are told. The oldest give way and are lost then. Shared: what a
/// process that died did not tell, the next one tells.
class ChangeQueue {
 public:
  struct Change {
    std::size_t line = 0;
    LevelSince level;
  };

  explicit ChangeQueue(std::size_t capacity) : changes_(capacity), state_(1) {}

  void push(const Change& change) {
    State& s = state_[0];
    const std::size_t capacity = changes_.all().size();
    changes_[(s.first + s.count) % capacity] = change;
    if (s.count < capacity) {
      ++s.count;
    } else {
      s.first = (s.first + 1) % capacity;
      ++s.lost;
    }
  }
  void lose(std::uint32_t count) { state_[0].lost += count; }
  bool any() const { return state_[0].count != 0 || state_[0].lost != 0; }

  /// The oldest one; nullopt: there is none.
  std::optional<Change> take() {
    State& s = state_[0];
    if (s.count == 0) return std::nullopt;
    const Change oldest = changes_[s.first];
    s.first = (s.first + 1) % changes_.all().size();
    --s.count;
    return oldest;
  }
  /// How many were lost since the last call.
  std::uint32_t take_lost() { return std::exchange(state_[0].lost, 0); }

 private:
  struct State {
    std::size_t first = 0;
    std::size_t count = 0;
    std::uint32_t lost = 0;
  };
  SharedArray<Change> changes_;
  SharedArray<State> state_;
};

/// The known state of an input, from the edges that the kernel reports and from looking at its level.
class WatchedLine {
 public:
  /// `counted`: the edges that counters and latched points want. `level`: the line's when reporting began.
  WatchedLine(std::size_t line, std::optional<Edge> counted, std::chrono::microseconds debounce, bool level)
      : line_(line),
        is_counted_(counted.has_value()),
        tally_(counted.value_or(Edge::both), level),
        level_(level),
        told_(level) {
    if (debounce.count() > 0) debounce_.emplace(debounce, level);
  }

  /// An edge is reported a little after the level is there. One that is not reported within this time never
  /// will be.
  static constexpr std::chrono::milliseconds patience{20};

  /// The kernel reported an edge.
  void edge(bool rising, TimePoint at, ChangeQueue& changes) {
    doubted_.reset();
    // It may report an edge after the level that the edge brought has been looked at.
    if (at <= looked_ && rising == latest()) return;
    at = std::max(at, last_);
    last_ = at;
    if (!debounce_)
      put({rising, at}, changes);
    else if (const auto settled = debounce_->edge(rising, at))
      put(*settled, changes);
  }

  /// The kernel dropped at least so many edges. How many of them were bouncing, nobody knows.
  void lose(std::uint32_t count, ChangeQueue& changes) {
    if (debounce_) count = 1;
    tally_.lose(count);
    changes.lose(count);
  }

  /// The line had this level at `now`, when the reported edges had been taken. If that is news, an edge was
  /// not reported, or nobody reports edges of this line.
  void look(bool level, TimePoint now, ChangeQueue& changes) {
    error_ = 0;
    doubted_.reset();
    if (level == latest()) return;
    edge(level, now, changes);
    looked_ = now;
  }

  /// The same of a line whose edges the kernel reports: the edge to this level may be on its way, so the line
  /// is to be checked again when its doubt is due.
  void check(bool level, TimePoint now, ChangeQueue& changes) {
    error_ = 0;
    if (level == latest()) return doubted_.reset();
    if (!doubted_) doubted_ = now;
    if (now - *doubted_ >= patience) look(level, now, changes);
  }
  /// Looking at it failed, with this errno: it is to be checked again, but not at once. Returns whether that
  /// is news.
  bool fail(int error, TimePoint now) {
    doubted_ = now;
    return std::exchange(error_, error) == 0;
  }
  /// The error of the last look; 0 if there was none.
  int error() const { return error_; }
  /// When it is to be checked again; nullopt: there is no doubt.
  std::optional<TimePoint> doubt_due() const {
    return doubted_ ? std::optional(*doubted_ + patience) : std::nullopt;
  }

  /// Notes a level that has been stable for the debounce period by now.
  void settle(TimePoint now, ChangeQueue& changes) {
    if (!debounce_) return;
    if (const auto settled = debounce_->settle(now)) put(*settled, changes);
  }
  std::optional<TimePoint> due() const { return debounce_ ? debounce_->due() : std::nullopt; }

  /// The level that counts.
  bool level() const { return level_; }
  /// The line's own level, as it bounces.
  bool latest() const { return debounce_ ? debounce_->latest() : level_; }

  /// Returns whether a change to this level, which is told now, brings another level than the last one told.
  /// If not, changes between them were lost.
  bool tell(bool level) { return std::exchange(told_, level) != level; }

  /// Edges that counters and latched points want, since the last call.
  Edges take_edges() {
    const Edges edges = tally_.take();
    return is_counted_ ? edges : Edges{};
  }

 private:
  void put(LevelSince level, ChangeQueue& changes) {
    if (tally_.edge(level.level)) changes.lose(1);
    level_ = level.level;
    changes.push({line_, level});
  }

  std::size_t line_;
  bool is_counted_;
  EdgeTally tally_;
  std::optional<Debounce> debounce_;
  bool level_;
  bool told_;
  TimePoint last_ = TimePoint::min();    ///< of the last edge
  TimePoint looked_ = TimePoint::min();  ///< when looking found what no edge had told
  std::optional<TimePoint> doubted_;  ///< since then it has a level that no edge has told, or an unknown one
  int error_ = 0;
};

}  // namespace coupler::device
