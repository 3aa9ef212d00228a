// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string_view>

#include "coupler/device/core/change_ring.hpp"
#include "coupler/device/core/changes.hpp"
#include "coupler/device/core/image.hpp"
#include "coupler/modbus/limits.hpp"

namespace coupler::device {

/// Wakes the thread that puts values of a firmware into the image, so that they do not wait for the next
/// request.
class Waker {
 public:
  /// Called in any thread.
  virtual void wake() = 0;

 protected:
  ~Waker() = default;
};

/// The level that a firmware wants an output with a line to have. The point is an index into Map::points.
struct WantedOutput {
  std::uint32_t point;
  bool level;
};

/// A firmware's own code behind the points that nothing else is behind (has_hardware() is false), and beside
/// those that have a line. Points are indices into Map::points. All of it is called in the thread that
/// answers clients, but for make_safe().
class Hooks {
 public:
  virtual ~Hooks() = default;

  /// This process begins to answer clients, in this thread: the place to start threads of one's own, and to
  /// open what they need. A node serves in a child process, and in another one if that dies.
  virtual void serving_began() {}

  /// Values may be set in this process. `waker`, which outlives this, is told of them; null: nobody is.
  virtual void allow_setting([[maybe_unused]] Waker* waker) {}

  /// Puts into the image what the firmware has set since the last call, and has it compared.
  virtual void put_new_values(Image& image, Changes& changes) = 0;

  /// A client writes the point: range(point).count() registers, or bits as 0 or 1. False refuses. When
  /// another point of the same request is refused, those already accepted are called again with the values
  /// they had.
  [[nodiscard]] virtual bool accept(std::uint32_t point, const std::uint16_t* registers) = 0;

  /// Why accept(), which has just been called, refuses, if the firmware says so; otherwise empty. It is told
  /// once, for the log.
  [[nodiscard]] virtual std::string_view take_reason() { return {}; }

  /// Returns the levels that the firmware wants outputs with a line to have, which are driven in this order.
  /// They are valid until the next call, and are handed out once.
  [[nodiscard]] virtual Span<const WantedOutput> take_wanted_outputs() { return {}; }

  /// This output was not driven, because the watchdog keeps it in its safe state, or else because its line
  /// fails.
  virtual void not_driven(const WantedOutput& /*wanted*/, bool /*watchdog*/) {}

  /// Returns whether take_level() is to be called as soon as an input's line changes. It is asked once.
  [[nodiscard]] virtual bool hears_lines() const noexcept { return false; }

  /// The line of the point has this level; `is_news`: from now on. False: the firmware's code has failed at
  /// it, so the outputs are to go to their safe state.
  [[nodiscard]] virtual bool take_level(std::uint32_t /*point*/, bool /*level*/, bool /*is_news*/) {
    return true;
  }

  /// Returns whether the node shows that it is one, by its identity area and by FC 20, 43, 65 and 66. It is
  /// asked once.
  [[nodiscard]] virtual bool shows_identity() const noexcept { return true; }

  /// Returns whether the node answers. It is asked when a client has sent something. If the node does not
  /// answer, the connection is closed, as that to a device which has gone.
  [[nodiscard]] virtual bool answers() { return true; }

  /// A client reads these addresses: the exception that it gets in place of them; nullopt: none. What the
  /// same request (FC 23) would write is not written then.
  [[nodiscard]] virtual std::optional<modbus::Exception> refuse_read(Table /*table*/,
                                                                     modbus::Range /*range*/) {
    return std::nullopt;
  }

  /// Why the node is to end, if this code has asked for it; otherwise empty. For the log.
  [[nodiscard]] virtual std::string_view why_it_ends() const noexcept { return {}; }

  /// The watchdog expired, or the node ends. When the process that serves has died, this is called in another
  /// one, in which serving_began() was not called.
  virtual void make_safe() {}
};

/// Writes to points that a firmware's code is behind or is asked about, what that code sets, and what it
/// hears of lines. The image holds what it accepted.
class HookedPoints {
 public:
  /// All of them outlive it.
  HookedPoints(const Map& map, Image& image, Hooks& hooks) : map_(map), image_(image), hooks_(hooks) {}

  void put_new_values(Changes& changes) { hooks_.put_new_values(image_, changes); }

  /// Asks about the points that have an address in the range, in the order of their addresses, what `next`
  /// says: one element for each. A point that is written in part is asked about as a whole; one that shares
  /// its register only if its own bits change. False if one is refused: then the others have their values
  /// again.
  [[nodiscard]] bool write(Table table, modbus::Range range, Span<const std::uint16_t> next);

  /// Checks each value by itself, as write() does, but only values that are not in force, and none of a line:
  /// its duration ends whatever the firmware says. Overwrites in `next` those that are refused with the
  /// values in force. Returns false if there is one.
  [[nodiscard]] bool write_each(Table table, modbus::Range range, Span<std::uint16_t> next);

  /// Gives the points that write() has just accepted their values again.
  void take_back(Table table, modbus::Range range, Span<const std::uint16_t> next);

  /// Returns whether the range contains an address of such an output.
  bool has_output(Table table, modbus::Range range) const;

  [[nodiscard]] bool shows_identity() const noexcept { return hooks_.shows_identity(); }
  [[nodiscard]] bool answers() { return hooks_.answers(); }
  [[nodiscard]] std::optional<modbus::Exception> refuse_read(Table table, modbus::Range range) {
    return hooks_.refuse_read(table, range);
  }

  /// See Hooks.
  [[nodiscard]] Span<const WantedOutput> take_wanted_outputs() { return hooks_.take_wanted_outputs(); }
  void not_driven(const WantedOutput& wanted, bool watchdog) { hooks_.not_driven(wanted, watchdog); }
  [[nodiscard]] bool hears_lines() const noexcept { return hooks_.hears_lines(); }

  /// The firmware gets the levels of all lines, as the image has them now.
  void begin_levels(const ChangeRing& ring);
  /// It hears of the changes of lines since the last call, one by one, and where some were lost, of the
  /// levels in the image. False: its code has failed.
  [[nodiscard]] bool tell_levels(const ChangeRing& ring);

  void make_safe() { hooks_.make_safe(); }

 private:
  struct Indices {
    std::uint32_t first;
    std::uint32_t end;
  };
  Indices touched(Table table, modbus::Range range) const;
  bool is_asked(std::uint32_t point, modbus::Range range, Span<const std::uint16_t> next);
  Span<const std::uint16_t> before(std::uint32_t point) const;
  void take_back(Indices points, modbus::Range range, Span<const std::uint16_t> next);
  bool tell(const modbus::Change& change);
  bool show_levels(bool are_news);

  const Map& map_;
  Image& image_;
  Hooks& hooks_;
  std::array<std::uint16_t, modbus::max_read_bits> value_{};  ///< of the point that is asked about
  std::uint64_t heard_ = 0;                                   ///< number of the last change that was told
};

}  // namespace coupler::device
