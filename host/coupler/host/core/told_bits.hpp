// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "coupler/host/core/change_listener.hpp"
#include "coupler/host/core/point_quality.hpp"
#include "coupler/host/core/poll_cycle.hpp"
#include "coupler/host/core/sink.hpp"
#include "coupler/host/core/writer.hpp"

namespace coupler::host {

/// The points of coils and discrete inputs at a node that tells changes. Each is read once; a change is then
/// given to the sink as if the point had been read. Under `publish: on_change` it is not read again until
/// something was missed: it rests.
///
/// An array whose bits change in one step of the node is shown once.
///
/// No value flickers back, and no change is left out for one that was read: where more changes follow than
/// one answer holds, a value that is read meanwhile is newer than they are, and is not shown unless it is the
/// one that was shown last. Only where changes were lost it is, and then those that it is newer than are not.
/// A change is not shown either if it is older than a value that is to be written. Of one between the answers
/// to the wait and to the read nobody can tell, so it is shown. A bit that was read has the level that it has
/// had or has next, so it does not flicker even then; an array may.
class ToldBits : public ChangeSink {
 public:
  /// Everything given by reference must outlive it.
  ToldBits(const Map& map, PollCycle& cycle, Writer& writer, PointQualities& qualities, Sink& sink);

  /// A new connection, after PollCycle::start(). `told`: the device tells changes.
  void start(bool told);
  /// As PollCycle's. If it is wanted again, or still, it is read soon, since somebody has not seen it.
  void want(std::uint32_t point, bool wanted);
  /// What was read of some points may not be shown.
  bool leaves_out_any() const { return active_ && more_follow_; }
  /// Whether that is so of this point of the span. If somebody waits for it, it is read again when all
  /// changes have come.
  bool leave_out(std::uint32_t point, const ReadSpan& span, Span<const std::uint8_t> bits);
  /// These points have been read, and are to be shown. Returns the stamp to show them with: that of a point
  /// does not go back.
  Stamp read(const ReadSpan& span, Span<const std::uint8_t> bits, Stamp stamp);

  void on_change(const modbus::Change& change, std::uint64_t number, Stamp stamp) override;
  void on_new_epoch() override;
  void on_gap() override;
  void on_heard(std::uint64_t newest, std::optional<Stamp> stamp) override;
  void on_end() override;
  Time answer_wanted() override;

 private:
  struct Told {
    std::uint32_t point;
    std::size_t first;                ///< its bits begin there
    bool known = false;               ///< they are those of the device
    bool left_out = false;            ///< and somebody waits
    std::uint64_t newer_than = 0;     ///< they are newer than this change
    Stamp stamp{};                    ///< the last one
    std::optional<Time> repeat_at{};  ///< as Sink's; nullopt: to be asked for
    /// Bits of an array that change in one step are told one by one: shown when all of them have come.
    std::optional<Stamp> pending{};
    modbus::NodeTime pending_at{};  ///< the step's time
  };
  /// Its bits in what was read.
  const std::uint8_t* in(const ReadSpan& span, Span<const std::uint8_t> bits, const Told& told) const;
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
  PointQualities& qualities_;
  Sink& sink_;
  std::vector<Told> points_;
  std::vector<std::optional<std::uint32_t>> index_;          ///< in points_, by point
  std::vector<std::pair<std::uint32_t, std::uint32_t>> at_;  ///< place of a bit, index in points_; sorted
  std::vector<std::uint8_t> bits_;
  bool active_ = false;
  std::uint64_t newest_ = 0;
  bool more_follow_ = false;                                 ///< up to this
  ReadSpan one_{Table::coils, modbus::Range::of(0, 1), {}};  ///< kept for its memory
};

}  // namespace coupler::host
