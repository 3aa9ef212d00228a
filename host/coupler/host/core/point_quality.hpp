// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "coupler/base/span.hpp"
#include "coupler/host/core/clock.hpp"
#include "coupler/host/core/write.hpp"
#include "coupler/map/map.hpp"
#include "coupler/modbus/pdu.hpp"

namespace coupler::host {

/// How far the last value of a point can be trusted, and what became of the last write to it.
struct PointQuality {
  enum class State : std::uint8_t {
    good,
    stale,       ///< nothing new for two periods of its rate and a timeout
    never_read,  ///< since the program began
    exception,   ///< the last read was answered with an exception
    rejected,    ///< the device does not have it: not read again while the connection lasts, or set aside
    offline,     ///< the device does not answer
    not_wanted   ///< not read, since nobody listens to it
  };
  State state = State::never_read;
  Time stale_from = Time::max();                      ///< of a good one: if nothing new comes
  std::optional<Time> last_good{};                    ///< of the last value
  std::optional<modbus::Exception> last_exception{};  ///< the last one there was, however long ago
  std::string why{};                                  ///< what came instead of a reply; empty: there was one
  std::optional<WriteResult::Outcome> last_write{};   ///< of the last one that no newer one superseded
  std::string last_write_text{};                      ///< to_string() of its result

  /// Of one that is refused now; 0: something else came instead of a reply, as `why` says.
  unsigned refused_with() const {
    return why.empty() && last_exception ? static_cast<unsigned>(*last_exception) : 0;
  }
};

/// "good", "never read" …
std::string_view to_string(PointQuality::State state);

/// The quality of each point of a device; read from any thread.
class PointQualities {
 public:
  explicit PointQualities(const Map& map);

  void good(Span<const std::uint32_t> points, Time at);
  void exception(Span<const std::uint32_t> points, modbus::Exception code);
  void wrote(std::uint32_t point, const WriteResult& result);
  void rejected(Span<const std::uint32_t> points, modbus::Exception code);
  /// The request for them ends the connection, and `why`: they are read seldom, if ever.
  void set_aside(Span<const std::uint32_t> points, const std::string& why);
  /// Whether the device tells changes of the point: its value does not become stale then.
  void told(std::uint32_t point, bool told);
  /// The last values of told points were still true `at`.
  void heard(Time at);
  /// What the device rejected over an earlier connection may be there now.
  void connected();
  void online(bool online);

  /// By point, as of `now`. Points that can only be written stay never_read.
  std::vector<PointQuality> snapshot(Time now) const;
  PointQuality of(std::uint32_t point, Time now) const;
  /// Changes whenever a state, exception or write in the snapshot changes, unless only by the passing of
  /// time.
  std::uint64_t revision() const { return revision_; }

 private:
  struct Entry {
    Duration stale_after{};  ///< what is older is stale
    std::optional<Time> last_good{};
    std::optional<modbus::Exception> last_exception{};
    std::optional<WriteResult::Outcome> last_write{};
    std::string last_write_text{};
    std::string why{};
    bool failing = false;
    bool rejected = false;
    bool told = false;
  };
  PointQuality quality_of(const Entry& entry, Time now) const;
  PointQuality::State state_of(const Entry& entry, Time now) const;

  mutable std::mutex mutex_;
  std::vector<Entry> points_;
  bool online_ = false;
  Time heard_ = Time::min();
  std::atomic<std::uint64_t> revision_{0};
};

}  // namespace coupler::host
