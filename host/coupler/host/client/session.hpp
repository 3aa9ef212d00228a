// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <condition_variable>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <shared_mutex>
#include <string>
#include <vector>

#include <tl/expected.hpp>

#include "coupler/host/client/scheduling.hpp"
#include "coupler/host/client/set_result.hpp"
#include "coupler/host/client/value_listeners.hpp"
#include "coupler/host/core/device_thread.hpp"
#include "coupler/host/core/value_table.hpp"
#include "coupler/map/tls_texts.hpp"

namespace coupler::client {

using coupler::Verify;
using host::Level;
using Quality = host::PointQuality::State;

struct Options {
  /// A host, or as the tools take it: tcp://HOST:PORT/UNIT, tls://HOST:PORT/UNIT, rtu+tcp://HOST:PORT/UNIT,
  /// rtu:DEVICE/UNIT?baud=…&parity=… Empty: the map's.
  std::string address;
  std::optional<std::uint16_t> port;  ///< default: the map's
  /// Options that are set replace those in the map's `tls`. Paths begin in the working directory.
  TlsTexts tls{};
  std::optional<Verify> verify;  ///< what to do if the device has another map; default: the map's
  /// Gets lines for a log: why the device cannot be reached, how two maps differ. Called in the connection's
  /// thread, or in one that sets a value; it must neither wait nor use the client. A line at which it throws
  /// goes to stderr.
  std::function<void(Level, const std::string&)> on_report{};
};

/// Why there is no value.
struct NoValue {
  Quality quality = Quality::never_read;         ///< of the last reading
  std::optional<modbus::Exception> exception{};  ///< the last one
  std::string why_unusable{};  ///< why what was read last is no value; empty if nothing was read
};
std::string to_string(const NoValue& why);

class Session;

/// A value that a point is to have: see Session::write_all().
struct NewValue {
  const Session* session;
  host::Write write;
  std::string wrong{};  ///< why the point cannot have it, and which values it can have; empty if it can
};

/// One coupler as the generated clients see it: a connection that reconnects by itself, the last values, and
/// writes. It runs the engine of the ROS driver in a thread of its own, with the same poll plan, write queue
/// and identity check.
///
/// All may be called from any thread. Callbacks come in the connection's thread: they may read and set
/// points, but must neither wait nor connect nor disconnect. What they throw is reported, once
/// for each of them: to Options::on_report, or on stderr if there is none.
class Session {
 public:
  virtual ~Session();
  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;

  /// Connects in the background, again and again until disconnect(). Returns at once, or when another
  /// thread's disconnect() has.
  void connect();
  /// Ends the connection, outputs as the map's `on_shutdown` says. The last values stay, as offline; after
  /// another connect(), once the device answers, as stale until they are read.
  void disconnect();

  /// The device answers, and has this map.
  bool online() const;
  /// Waits for online(); false if it is not within `at_most`.
  bool wait_online(std::chrono::milliseconds at_most) const;
  /// Calls `use(online())` each time that it changes; set it before connect() to miss none. The rest is as
  /// said of Input::on_change().
  void on_online(std::function<void(bool)> use);

  /// Sends several values, each of which is `point.to(value)`, by table and address: neighbours in one
  /// request, as far as the map lets them (docs/driver-writes.md). If one is not valid for its point, none is
  /// sent.
  PendingWrite write_all(const std::vector<NewValue>& values);

 protected:
  /// The storage of `map` must outlive it. The destructor of a derived class must call disconnect(): until
  /// then callbacks may use its points.
  Session(const Map& map, Options options);

 private:
  friend class PointHandle;
  struct Sample {
    std::vector<std::uint16_t> registers;
    Quality quality;
    host::Duration age;
  };
  tl::expected<Sample, NoValue> sample(std::uint32_t point) const;
  void listen(std::uint32_t point, ValueListeners::Listener listener);
  PendingWrite write(host::Write& write);
  PendingSchedule schedule(const host::ScheduledWrite& what);
  void come_or_go(bool online);
  /// The place of on_online() among the listeners.
  std::uint32_t connection() const { return static_cast<std::uint32_t>(map_.points.size()); }

  struct Engine;

  const Options options_;
  const Map map_;
  host::ValueTable values_;
  ValueListeners listeners_;  ///< of the points, and behind them that of on_online()
  ScheduleResults scheduled_;
  mutable std::mutex online_mutex_;
  mutable std::condition_variable came_online_;
  bool online_ = false;
  std::mutex connecting_;                   ///< held by connect() and disconnect(): one engine at a time
  mutable std::shared_mutex engine_mutex_;  ///< engine_ is not replaced while it is used
  std::unique_ptr<Engine> engine_;          ///< null: disconnected
};

/// The part that the points of a client have in common.
class PointHandle {
 public:
  /// The point as the map describes it: name, units, description, place.
  const Point& point() const { return session_.map_.points[index_]; }

 protected:
  using Sample = Session::Sample;

  PointHandle(Session& session, std::uint32_t index) : session_(session), index_(index) {}

  tl::expected<Sample, NoValue> sample() const { return session_.sample(index_); }
  tl::expected<Sample, NoValue> first_sample(std::chrono::milliseconds at_most) const {
    const host::Time deadline = std::chrono::steady_clock::now() + at_most;
    session_.values_.wait(index_, host::Time::min(), deadline, host::ValueTable::Offline::waits);
    return session_.sample(index_);
  }
  void listen(ValueListeners::Listener listener) { session_.listen(index_, std::move(listener)); }
  /// `registers` as TypedValue encodes them, here and below.
  NewValue new_value(const std::uint16_t* registers, std::string wrong) const {
    return {&session_, make_write(registers), std::move(wrong)};
  }
  PendingWrite write(const std::uint16_t* registers);
  PendingSchedule write_at(const std::uint16_t* registers, host::Time due,
                           std::chrono::milliseconds duration);
  /// The answer to what is not valid.
  static PendingSchedule refuse_at(std::string why);

 private:
  host::Write make_write(const std::uint16_t* registers) const;

  Session& session_;
  std::uint32_t index_;
};

}  // namespace coupler::client
