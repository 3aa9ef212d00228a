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

/// How far the last value of a point can be trusted, and the result of the last write to it.
struct PointQuality {
  enum class State : std::uint8_t {
    good,
    stale,       ///< nothing new has come for two periods of its rate and a timeout
    never_read,  ///< not read since the program began
    exception,   ///< the last read was answered with an exception
    rejected,    ///< the device does not have it; not read again over this connection, or set aside
    offline,     ///< the device does not answer
    not_wanted   ///< not read, because nobody listens to it
  };
  State state = State::never_read;
  Time stale_from = Time::max();    ///< the time at which a good value becomes stale if nothing new comes
  std::optional<Time> last_good{};  ///< the time of the last value
  std::optional<modbus::Exception> last_exception{};  ///< the last exception, however long ago
  std::string why{};  ///< what came instead of a reply; empty if there was a reply
  std::optional<WriteResult::Outcome> last_write{};  ///< that of the last write that was not superseded
  std::string last_write_text{};                     ///< to_string() of its result

  /// The exception of a point that is refused now; 0 if something else came instead of a reply, as `why`
  /// says.
  unsigned refused_with() const {
    return why.empty() && last_exception ? static_cast<unsigned>(*last_exception) : 0;
  }
};

/// Returns a text as "good" or "never read".
std::string_view to_string(PointQuality::State state);

/// The quality of each point of a device. Any thread may read it.
class PointQualities {
 public:
  explicit PointQualities(const Map& map);

  void good(Span<const std::uint32_t> points, Time at);
  void exception(Span<const std::uint32_t> points, modbus::Exception code);
  void wrote(std::uint32_t point, const WriteResult& result);
  void rejected(Span<const std::uint32_t> points, modbus::Exception code);
  /// Notes that the request for these points ends the connection, and `why`. They are read seldom, if ever.
  void set_aside(Span<const std::uint32_t> points, const std::string& why);
  /// Sets whether the device tells changes of the point. Its value does not become stale then.
  void told(std::uint32_t point, bool told);
  /// Notes that the last values of told points were still true at the time `at`.
  void heard(Time at);
  /// Forgets what the device rejected over an earlier connection.
  void connected();
  void online(bool online);

  /// Returns the quality of each point at the time `now`. Points that can only be written stay never_read.
  std::vector<PointQuality> snapshot(Time now) const;
  PointQuality of(std::uint32_t point, Time now) const;
  /// A number that changes with each state, exception and write in the snapshot, but not by the mere passing
  /// of time.
  std::uint64_t revision() const { return revision_; }

 private:
  struct Entry {
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
  PointQuality quality_of(const Entry& entry, Time now) const;
  PointQuality::State state_of(const Entry& entry, Time now) const;

  mutable std::mutex mutex_;
  std::vector<Entry> points_;
  bool online_ = false;
  Time heard_ = Time::min();
  std::atomic<std::uint64_t> revision_{0};
};

}  // namespace coupler::host
