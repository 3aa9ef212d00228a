// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/client/session.hpp"

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <utility>

#include <fmt/format.h>

#include "coupler/host/modbus/make_links.hpp"
#include "coupler/map/loader/load.hpp"
#include "coupler/map/node_address.hpp"

namespace coupler::client {
namespace {

/// Makes the paths absolute, so that they mean the same as long as the options exist.
Options with_absolute_paths(Options options) {
  for (std::string* path : {&options.tls.certificate, &options.tls.key, &options.tls.ca})
    if (!path->empty()) *path = std::filesystem::absolute(*path).string();
  return options;
}

/// Why the options cannot be understood, and what to do; empty: `connection` is where they say.
std::string move_to(Map& map, const Options& options) {
  Connection& connection = map.connection;
  const bool had_tls = connection.tls.present();
  overlay(connection.tls, options.tls.view());
  const bool has_tls = connection.tls.present();
  if (has_tls && !had_tls && connection.port == modbus::default_port) connection.port = default_tls_port;
  if (names_a_node(options.address)) {
    const auto where = parse_node_address(options.address, connection);
    if (!where) return fmt::format("{}; {}", where.error().what, where.error().remedy);
    if (where->tls && !has_tls)
      return fmt::format(
          "{}: there are no certificates for TLS; add them to the map, as in 'tls: {{certificate: cell1.pem, "
          "key: cell1.key, ca: authority.pem}}', or to Options::tls",
          options.address);
    map = found_at(map, *where);
  } else if (!options.address.empty()) {
    map = found_at(map, {options.address, connection.port, connection.unit, Framing::tcp, {}, has_tls});
  }
  if (const auto missing = missing_key(connection.tls); !missing.empty())
    return fmt::format("TLS needs '{}', too; add it to the map's 'tls', or to Options::tls", missing);
  if (!connection.tls.ca.empty() && !connection.tls.pin.empty())
    return "TLS has both 'ca' and 'pin'; give the device's authority, or the pin of its certificate";
  if (const auto pin = connection.tls.pin; !pin.empty() && !is_pin(pin))
    return fmt::format(
        "'{}' is no pin; write 'sha256:' and 64 hexadecimal digits, as `coupler pin` prints them", pin);
  if (options.port) connection.port = *options.port;
  return {};
}

void print(const std::string& text) { std::fputs((text + '\n').c_str(), stderr); }

/// Reports a text. An exception of the callback ends here, because the connection's thread has to look after
/// outputs.
void report(const Options& options, Level level, const std::string& text) {
  try {
    if (options.on_report) options.on_report(level, text);
  } catch (...) {
    print(text);  // nobody else is left to be told
  }
}

/// A connection to nowhere if the options cannot be understood; that is reported.
Map moved(Map map, const Options& options) {
  if (const std::string wrong = move_to(map, options); !wrong.empty()) {
    map.connection = {};
    report(options, Level::error, wrong);
  }
  return map;
}

constexpr host::WriteResult not_connected = {SetResult::Outcome::dropped, std::nullopt,
                                             "not connected; call connect() first"};

std::future<host::ScheduleAnswer> known(host::ScheduleAnswer answer) {
  std::promise<host::ScheduleAnswer> promise;
  promise.set_value(std::move(answer));
  return promise.get_future();
}

}  // namespace

/// A connection, whose thread calls the functions of Sink.
struct Session::Engine final : host::Sink {
  Engine(Session& of, Verify verify)
      : session(of),
        link(host::make_link(of.map_.connection, of.map_.limits)),
        thread(of.map_, verify, load_served_map, link, of.values_, *this) {
    thread.start();
  }

  void on_values(Span<const std::uint32_t> points) override {
    const host::ValueTable& values = session.values_;
    for (const std::uint32_t point : points)
      if (values.differs(point)) session.listeners_.call(point, values.registers(point), values.stamp(point));
  }
  void on_online(bool online) override { session.come_or_go(online); }
  void on_report(Level level, const std::string& text) override { report(session.options_, level, text); }
  void on_scheduled(const host::ScheduledOutcome& outcome) override { session.scheduled_.tell(outcome); }

  Session& session;
  host::Link link;
  host::DeviceThread thread;
};

std::string to_string(const NoValue& why) {
  if (why.quality == Quality::never_read) return "was not read yet";
  if (why.quality == Quality::offline)
    return fmt::format("{}: the device does not answer",
                       why.why_unusable.empty() ? "was not read yet" : "has no value");
  if (!why.why_unusable.empty() && !host::PointQuality::is_refused(why.quality))
    return "has no value: " + why.why_unusable;
  return fmt::format("cannot be read: {}",
                     why.exception ? host::to_string(host::Error(host::ExceptionReply{*why.exception}))
                                   : std::string(host::to_string(why.quality)));
}

Session::Session(const Map& map, Options options)
    : options_(with_absolute_paths(std::move(options))),
      map_(moved(map, options_)),
      values_(map_),
      listeners_(map_.points.size() + 1) {}

Session::~Session() { disconnect(); }

void Session::connect() {
  const std::lock_guard whole(connecting_);
  const std::unique_lock lock(engine_mutex_);
  if (engine_) return;
  values_.begin();
  engine_ = std::make_unique<Engine>(*this, options_.verify.value_or(map_.verify));
}

void Session::disconnect() {
  const std::lock_guard whole(connecting_);
  std::unique_ptr<Engine> engine;
  {
    const std::unique_lock lock(engine_mutex_);
    engine = std::move(engine_);
  }
  engine.reset();  // outside the lock: callbacks that run now may set points
}

bool Session::online() const {
  const std::lock_guard lock(online_mutex_);
  return online_;
}

bool Session::wait_online(std::chrono::milliseconds at_most) const {
  std::unique_lock lock(online_mutex_);
  return came_online_.wait_for(lock, at_most, [this] { return online_; });
}

tl::expected<Session::Sample, NoValue> Session::sample(std::uint32_t point) const {
  const host::Time now = std::chrono::steady_clock::now();
  host::ValueTable::Value value = values_.get(point, now);
  const host::PointQuality& quality = value.quality;
  if (!value.has_value())
    return tl::unexpected(NoValue{quality.state, quality.last_exception, value.why_unusable});
  // If a node tells changes, a value is known to be true for longer than since its last change.
  const bool was_true_then =
      (quality.state == Quality::good || quality.state == Quality::offline) && quality.last_good;
  const host::Time at = was_true_then ? std::max(value.stamp.at, *quality.last_good) : value.stamp.at;
  return Sample{std::move(value.registers), quality.state, std::max<host::Duration>(now - at, {})};
}

PendingWrite Session::write(host::Write& write) {
  PendingWrite pending = listen_to(write);
  const std::shared_lock lock(engine_mutex_);
  if (engine_)
    engine_->thread.write(write);
  else
    write.listener->on_result(not_connected);
  return pending;
}

PendingWrite Session::write_all(const std::vector<NewValue>& values) {
  std::vector<host::Write> writes;
  for (const NewValue& value : values) {
    const std::string_view name = value.session->map_.points[value.write.point].name;
    if (value.session != this)
      return refused("it is a point of another client; write to each by itself", name);
    if (!value.wrong.empty()) return refused(value.wrong, name);
    writes.push_back(value.write);
    writes.back().ordered = true;
  }
  if (writes.empty()) return refused("there is no value; give one at least");
  std::stable_sort(writes.begin(), writes.end(),
                   [](const host::Write& a, const host::Write& b) { return a.point < b.point; });
  PendingWrite pending = listen_to_all(writes, map_);
  const std::shared_lock lock(engine_mutex_);
  if (engine_)
    engine_->thread.write_together(writes);
  else
    for (const host::Write& write : writes) write.listener->on_result(not_connected);
  return pending;
}

PendingSchedule Session::schedule(const host::ScheduledWrite& what) {
  return scheduled_.expect(what, [this](const host::ScheduledWrite& expected) {
    const std::shared_lock lock(engine_mutex_);
    return engine_ ? engine_->thread.schedule(expected) : known({0, "not connected; call connect() first"});
  });
}

void Session::come_or_go(bool online) {
  {
    const std::lock_guard lock(online_mutex_);
    online_ = online;
    came_online_.notify_all();
  }
  const std::uint16_t told = online ? 1 : 0;
  listeners_.call(connection(), &told, {std::chrono::steady_clock::now(), {}});
}

void Session::on_online(std::function<void(bool)> use) {
  if (!use) return listen(connection(), {});
  listen(connection(),
         [use = std::move(use)](const std::uint16_t* online, host::Stamp) { use(*online != 0); });
}

void Session::listen(std::uint32_t point, ValueListeners::Listener listener) {
  if (!listener) return listeners_.set(point, {});
  auto tell = [this, point, told = false](std::string_view what) mutable {
    if (std::exchange(told, true)) return;
    const std::string text =
        fmt::format("{}: its callback threw an exception: {}; catch it there (reported once)",
                    point == connection() ? "on_online" : map_.points[point].name, what);
    report(options_, Level::error, text);
    if (!options_.on_report) print(text);
  };
  listeners_.set(point, [tell = std::move(tell), listener = std::move(listener)](
                            const std::uint16_t* registers, host::Stamp stamp) mutable {
    try {
      listener(registers, stamp);
    } catch (const std::exception& thrown) {
      tell(thrown.what());
    } catch (...) {
      tell("not a std::exception");
    }
  });
}

host::Write PointHandle::make_write(const std::uint16_t* registers) const {
  host::Write write;
  write.point = index_;
  const std::size_t count = range(point()).count();
  if (holds_bits(point().table)) {
    for (std::size_t i = 0; i < count; ++i)
      if (registers[i] != 0) write.set_bit(i);
  } else {
    std::copy(registers, registers + count, write.registers.begin());
  }
  return write;
}

PendingWrite PointHandle::write(const std::uint16_t* registers) {
  host::Write write = make_write(registers);
  return session_.write(write);
}

PendingSchedule PointHandle::write_at(const std::uint16_t* registers, host::Time due,
                                      std::chrono::milliseconds duration) {
  return session_.schedule({make_write(registers), due, duration, {}});
}

PendingSchedule PointHandle::refuse_at(std::string why) {
  return ScheduleResults().expect({}, [&](const auto&) { return known({0, std::move(why)}); });
}

}  // namespace coupler::client
