// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "coupler/base/span.hpp"
#include "coupler/host/core/point_quality.hpp"
#include "coupler/host/core/stamp.hpp"
#include "coupler/map/map.hpp"
#include "coupler/map/published.hpp"
#include "coupler/plan/read_span.hpp"

namespace coupler::host {

using plan::ReadSpan;

/// The last value of each point of a device, how far it can be trusted, and the result of the last write to
/// the point. The table may outlive a Device and serve the next one.
///
/// The device's thread stores the values, and may read them without a lock in Sink::on_values(). Other
/// threads get copies.
class ValueTable {
 public:
  /// A copy of what is known of a point.
  struct Value {
    std::vector<std::uint16_t>
        registers;  ///< host_registers() of them, bits as 0 or 1; empty: nothing was read yet
    Stamp stamp;
    std::uint64_t number = 0;  ///< how often the registers have changed, counting the first time
    PointQuality quality;
    PointQuality::State read_as = PointQuality::State::good;  ///< see last_read()
    std::string why_unusable;  ///< why what was read last is not to be used; empty: it is

    bool has_value() const { return number > 0 && why_unusable.empty(); }
  };

  /// The storage of `map` must outlive the table.
  explicit ValueTable(const Map& map);

  /// Prepares the table for another Device. Values from before are stale until they are read again. A
  /// Device that reconnects by itself calls connected() instead.
  void begin();

  // These calls are for the thread of the device.

  /// Stores the values of the points of `span`, which were good at the time `good_at`. `registers[i]` is the
  /// register `span.range.start() + i`, or that bit as 0 or 1.
  void store(const ReadSpan& span, Span<const std::uint16_t> registers, Stamp stamp, Time good_at);
  /// Returns whether the registers of the point that were read last are not stored yet, because they wait for
  /// the exponent of their scale, which another request of the same cycle reads.
  bool waits(std::uint32_t point) const {
    return entries_[point].scaling && scaling_[*entries_[point].scaling].waits;
  }
  /// The waiting points that the last call of store(), exception(), rejected() or set_aside() has settled.
  Span<const std::uint32_t> late() const { return late_; }
  /// Notes that the points can be read. Their values are not stored, because a write will replace them.
  void good(Span<const std::uint32_t> points, Time at);
  void exception(Span<const std::uint32_t> points, modbus::Exception code);
  void rejected(Span<const std::uint32_t> points, modbus::Exception code);
  /// Notes `why` these points are read seldom, or not at all: for example, because the request for them
  /// ends the connection, or because the device's map does not have them. An empty `why` takes that back.
  void set_aside(Span<const std::uint32_t> points, const std::string& why);
  /// Sets whether the device announces changes of the point. As long as it does, the value does not become
  /// stale.
  void told(std::uint32_t point, bool told);
  /// Notes that the last values of told points were still true at the time `at`.
  void heard(Time at);
  /// Forgets what the device rejected over an earlier connection, and what waits().
  void connected();
  void online(bool online);

  // The device's thread may call these functions in Sink::on_values().

  /// Returns whether any point has `invalid`, a fault limit or an exponent, so that what is read may be
  /// unusable.
  bool can_be_unusable() const { return can_be_unusable_; }
  /// Returns good, or, if what was read last is not to be used, invalid or fault.
  PointQuality::State last_read(std::uint32_t point) const { return entries_[point].read_as; }
  bool is_usable(std::uint32_t point) const { return last_read(point) == PointQuality::State::good; }
  /// The host_registers() of a point that was read.
  const std::uint16_t* registers(std::uint32_t point) const { return &registers_[entries_[point].first]; }
  Stamp stamp(std::uint32_t point) const { return entries_[point].stamp; }
  std::uint64_t number(std::uint32_t point) const { return entries_[point].number; }
  /// Returns whether the last value differs from the one before, or is the first one.
  bool differs(std::uint32_t point) const { return entries_[point].differs; }

  // Any thread may make these calls.

  void wrote(std::uint32_t point, const WriteResult& result);
  Value get(std::uint32_t point, Time now) const;
  enum class Offline { waits, gives_up };
  /// Waits until the point was read after begin(), and what was read was true at the time `since` or later.
  /// Returns false if it has none at `deadline`, after end_waits(), or, with Offline::gives_up, while the
  /// device is offline.
  bool wait(std::uint32_t point, Time since, Time deadline, Offline offline) const;
  /// Ends all waits, also those to come.
  void end_waits();
  /// Returns the quality of each point at the time `now`. Points that can only be written stay never_read.
  std::vector<PointQuality> qualities(Time now) const;
  PointQuality quality(std::uint32_t point, Time now) const;
  /// A part of get() that needs no memory.
  struct Freshness {
    PointQuality::State state;
    std::optional<Time> last_good;
    std::uint64_t number;
  };
  Freshness freshness(std::uint32_t point, Time now) const;
  /// The state that the point has while the device is online.
  PointQuality::State state_when_online(std::uint32_t point, Time now) const;
  /// A number that changes with each state, exception and write in qualities(), but neither by the mere
  /// passing of time nor with a value.
  std::uint64_t revision() const { return revision_; }

 private:
  struct Entry {
    std::size_t first = 0;     ///< the index of its first register in registers_
    std::uint16_t count = 0;   ///< the number of its registers or bits, without the power of ten
    std::uint32_t start = 0;   ///< the address from which the first one is read
    std::uint16_t mask = 0;    ///< the bits of each register that belong to the point
    std::uint64_t number = 0;  ///< see Value::number; 0 if the point has no value
    bool differs = false;
    PointQuality::State read_as = PointQuality::State::good;  ///< see last_read()
    bool lacks_exponent = false;             ///< it is invalid because its scale has no exponent
    std::uint64_t stored = 0;                ///< the number of the last store() of its span
    std::optional<std::uint32_t> scaling{};  ///< the index in scaling_, if its scale has an exponent
    Stamp stamp{};
    Duration stale_after{};  ///< an older value is stale
    std::optional<Time> last_good{};
    std::optional<modbus::Exception> last_exception{};
    std::optional<WriteResult::Outcome> last_write{};
    std::string last_write_text{};
    std::string why{};
    bool failing = false;
    bool rejected = false;
    bool told = false;
  };
  /// A point whose scale has an exponent. If that is read later in the cycle, by another request, the
  /// registers of the point wait for it here.
  struct Scaling {
    std::uint32_t point;
    std::uint32_t exponent;  ///< the point that holds it
    bool comes_later;        ///< it is read after the point
    bool waits = false;
    std::array<std::uint16_t, 4> registers{};  ///< no number has more
    Stamp stamp{};
    Time good_at{};
  };
  struct Taken {
    const std::uint16_t* registers;  ///< as they were read
    Stamp stamp;
    Time good_at;
  };
  bool store_scaled(const ReadSpan& span, Span<const std::uint16_t> registers, Stamp stamp, Time good_at);
  bool take(Entry& entry, const Taken& taken);
  void keep(Entry& entry, std::size_t i, std::uint16_t now);
  static bool is_expected(const Entry& entry);
  void set_waits(Scaling& scaling, bool waits);
  void settle(Span<const std::uint32_t> points);
  std::optional<std::int16_t> exponent_of(const Scaling& scaling, Time now) const;
  static void mark_good(Entry& entry, Time at);
  bool is_since(const Entry& entry, Time since) const;
  void notify();
  PointQuality quality_of(const Entry& entry, Time now) const;
  std::optional<Time> last_good_of(const Entry& entry, PointQuality::State state) const;
  PointQuality::State state_of(const Entry& entry, Time now) const;
  PointQuality::State read_state(const Entry& entry, Time now) const;
  std::string why_unusable(const Entry& entry, Time now) const;

  const Map map_;
  bool can_be_unusable_ = false;
  std::vector<std::uint32_t> late_;

  mutable std::mutex mutex_;
  std::vector<Entry> entries_;            ///< by point
  std::vector<std::uint16_t> registers_;  ///< of all points
  std::vector<Scaling> scaling_;
  std::uint64_t stores_ = 0;
  std::size_t waiting_ = 0;  ///< the number of elements of scaling_ that wait
  bool online_ = false;
  Time heard_ = Time::min();
  std::atomic<std::uint64_t> revision_{0};
  mutable int waits_ = 0;  ///< threads in wait()
  mutable std::condition_variable changed_;
  bool waits_end_ = false;
};

}  // namespace coupler::host
