// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "coupler/host/core/change_listener.hpp"
#include "coupler/host/core/poll_cycle.hpp"
#include "coupler/host/core/sink.hpp"
#include "coupler/host/core/value_table.hpp"
#include "coupler/host/core/writer.hpp"

namespace coupler::host {

/// The coils and discrete inputs of a node that tells changes. Each point is read once. After that each
/// change is given to the sink as if the point had been read. Under `publish: on_change` a point is not read
/// again until changes were missed: it rests.
///
/// An array whose bits change in one step of the node is published once.
///
/// No value flickers back, and no change is left out because of a value that was read. While changes
/// that did not fit into one reply are to come, a value just read is newer. It is published only if it equals
/// the last one, or if none is known, as after a loss; older changes are then discarded. A change that is
/// older than a value that waits to be written is not published. A change between the replies to the wait and
/// to the read cannot be ordered, so it is published. A single bit does not flicker even then, since the
/// value that was read is its old or its new level. An array may flicker.
class BitChanges : public ChangeSink {
 public:
  /// All references must outlive the object.
  BitChanges(const Map& map, PollCycle& cycle, Writer& writer, ValueTable& values, Sink& sink);

  /// Starts with a new connection, after PollCycle::start(). `told`: the device tells changes.
  void start(bool told);
  /// See PollCycle. If the point is wanted again, or was wanted already, it is read soon, because the new
  /// reader has not seen its value.
  void want(std::uint32_t point, bool wanted);
  /// Returns whether there are points whose values must not be published as they were read.
  bool leaves_out_any() const { return active_ && more_follow_; }
  /// Returns whether the value just read of this point must not be published. Under `publish: on_change` the
  /// point is read again when all changes have come.
  bool leave_out(std::uint32_t point, const ReadSpan& span, Span<const std::uint16_t> bits);
  /// Notes that these points have been read and will be published. Returns the stamp to publish them with.
  /// The stamp of a point never goes back.
  Stamp read(const ReadSpan& span, Span<const std::uint16_t> bits, Stamp stamp);

  void on_change(const modbus::Change& change, std::uint64_t number, Stamp stamp) override;
  void on_new_epoch() override;
  void on_gap() override;
  void on_heard(std::uint64_t newest, std::optional<Stamp> stamp) override;
  void on_end() override;
  Time answer_wanted() override;

 private:
  struct Told {
    std::uint32_t point;
    std::size_t first;      ///< the index of its first bit
    bool known = false;     ///< the bits are those of the device
    bool left_out = false;  ///< a value was not published: the point is read again when all changes have come
    std::uint64_t newer_than = 0;     ///< the bits are newer than this change
    Stamp stamp{};                    ///< the last published stamp
    std::optional<Time> repeat_at{};  ///< see Sink; nullopt: has to be asked for
    /// The stamp of array bits that have changed but are not published yet: those of one step arrive one at a
    /// time, and are published together.
    std::optional<Stamp> pending{};
    modbus::NodeTime pending_at{};  ///< the time of the step
  };
  /// Takes its bits from what was read.
  const std::uint16_t* in(const ReadSpan& span, Span<const std::uint16_t> bits, const Told& told) const;
  const Point& point_of(const Told& told) const { return map_.points[told.point]; }
  bool rests(const Told& told) const;
  bool repeats(const Told& told) const;
  Time repeat_at(Told& told);
  void forget(Told& told);
  void leave_out_older_than_writes();
  void change(Told& told, const modbus::Change& change, std::uint64_t number, Stamp stamp);
  void show_pending(Told& told);
  void show_unless_hidden(Told& told, Stamp stamp);
  void show(Told& told, Stamp stamp);

  const Map& map_;
  PollCycle& cycle_;
  Writer& writer_;
  ValueTable& values_;
  Sink& sink_;
  std::vector<Told> points_;
  std::vector<std::optional<std::uint32_t>> index_;          ///< by point: the index in points_
  std::vector<std::pair<std::uint32_t, std::uint32_t>> at_;  ///< place of a bit, index in points_; sorted
  std::vector<std::uint16_t> bits_;
  bool active_ = false;
  std::uint64_t newest_ = 0;  ///< the number of the node's newest change, as of its last answer
  Time heard_{};              ///< the time of that answer
  bool more_follow_ = false;  ///< changes up to newest_ are still to come
  ReadSpan one_{Table::coils, modbus::Range::of(0, 1), {}};  ///< a member, so that its memory is used again
};

}  // namespace coupler::host
