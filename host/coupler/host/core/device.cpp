// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/core/device.hpp"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "coupler/host/core/health.hpp"

namespace coupler::host {

Device::Device(const Map& map, Purpose purpose, MapLoader load, Link& link, ValueTable& values, Sink& sink)
    : map_(map),
      verify_(map.connection.is_broadcast() ? Verify::off : purpose.verify),
      only_looks_(purpose.only_looks),
      load_(std::move(load)),
      link_(link),
      clock_(link.clock()),
      sink_(sink),
      values_(values),
      watchdog_(map_, link_, statistics_, sink),
      writer_(map_, link_, statistics_, values_, sink),
      poller_(map_, link_, writer_, statistics_, values_, sink),
      scheduler_(map_, link_, writer_, poller_.changes(), sink),
      listener_(map.connection.timeout, link_, statistics_, scheduler_.changes(), sink) {
  if (only_looks_) poller_.only_look();
}

/// A serial line has no connection to keep alive, and a device whose points can only be written may not
/// even answer a read request. A program that only looks reads nothing but the points that it shows.
bool Device::needs_keep_alive() const {
  if (only_looks_) return false;
  const auto& points = map_.points;
  return !map_.connection.is_rtu() || verify_ != Verify::off ||
         std::any_of(points.begin(), points.end(), [](const Point& point) { return is_readable(point); });
}

Time Device::step() {
  if (holds_line_) tell_what_waits();
  if (!is_verified()) {
    writer_.disconnected(NotConnected{"not connected"});
    return clock_.now() < retry_at_ ? retry_at_ : connect();
  }
  if (const auto done = do_what_is_due(clock_.now()); !done) lost(done.error());
  return is_verified() ? due() : retry_at_;
}

Result<> Device::do_what_is_due(Time now) {
  Result<> answer;
  if (!writer_.awaits_answer()) answer = listener_.step();
  if (!answer) return answer;
  scheduler_.queue_due(now);
  const bool schedules = scheduler_.has_request(listener_);
  const Time write_due = std::min({writer_.due(), watchdog_.due(), scheduler_.due(listener_)});
  link_.rank(schedules || write_due <= now ? Rank::write : Rank::read);
  if (writer_.awaits_answer() || writer_.is_safe_asked())
    answer = write();
  else if (listener_.asks_for_watchdog())
    answer = ask_for_watchdog();
  else if (schedules)
    answer = scheduler_.step(listener_);
  else if (watchdog_.due() <= now)
    answer = serve_watchdog();
  else if (writer_.due() <= now)
    answer =
        is_read_first(now) && listener_.lets_read() && poller_.has_request(now) ? read_or_write() : write();
  else if (listener_.lets_read() && poller_.due() <= now)
    answer = read(write_due);
  else if (keep_alive_due() <= now && link_.await_turn(write_due) == Link::Turn::read)
    answer = poller_.last_answered() ? link_.ask(*poller_.last_answered()) : link_.keep_alive(map_);
  if (answer) answered();
  if (poller_.take_ended_cycle() && answer) cycle_ended();
  return answer;
}

void Device::cycle_ended() {
  // The back-off is not reset earlier, because a device may fail at the same request each time.
  if (only_looks_) backoff_.reset();
  sink_.on_cycle();
}

void Device::answered() {
  if (link_.replies() == replies_at_connect_) return;
  identity_suffices_ = true;
  came_online();
}

Result<> Device::write() {
  wrote_last_ = true;
  return writer_.step();
}

/// Reads, unless units share the connection: then a read and a write wait for a turn, and the one that gets
/// it first is made, so that no more than one read of the others comes before.
Result<> Device::read_or_write() {
  link_.rank(Rank::read);
  switch (link_.await_turn(Time::max(), true)) {
    case Link::Turn::none: return {};
    case Link::Turn::read: return read(Time::max());
    case Link::Turn::write: break;
  }
  link_.rank(Rank::write);
  return write();
}

Result<> Device::read(Time until) {
  const std::uint64_t replies = link_.replies();
  if (std::exchange(is_closed_, false))
    if (auto connected = link_.connect(); !connected) return connected;
  auto answer = poller_.step(until);
  if (link_.replies() != replies) wrote_last_ = false;
  return answer ? answer : go_on_without(answer.error());
}

/// A request to which a foreign device says nothing, or nonsense, ends the connection: what would come next
/// cannot be trusted. The first time the device may have been away, or started again. If it happens again,
/// and others are answered before and after, the request costs its own points only: nobody is told that the
/// device was away, no write is dropped, and nothing is restored. A program that only looks does this the
/// first time, because it does no harm if that was chance.
Result<> Device::go_on_without(const Error& error) {
  if (is_node_ || ending_) return tl::make_unexpected(error);
  if (reopens(error)) return {};
  if (!is_no_reply(error)) return tl::make_unexpected(error);
  const bool may_be_chance = !only_looks_ && !poller_.is_suspected();
  if (link_.replies() == replies_at_connect_ || may_be_chance) {
    poller_.ended_connection();
    return tl::make_unexpected(error);
  }
  if (is_closed(error)) {
    const Result<> alone = ask_alone();
    if (alone) poller_.acquit();
    if (alone || !is_no_reply(alone.error())) return tl::make_unexpected(error);
  }
  if (auto again = connect_again(); !again) return again;
  poller_.set_aside(error);
  return {};
}

/// Some devices end each connection after a number of requests, or for another client's. They answer this
/// request if it is the first one.
Result<> Device::ask_alone() {
  const Result<> connected = connect_only();
  return connected ? link_.ask(poller_.current()) : connected;
}

/// Connects again for a program that only looks, because some devices close a connection after a number of
/// requests. Returns whether the program can go on over the new connection.
bool Device::reopens(const Error& error) {
  if (!only_looks_ || is_node_ || !std::holds_alternative<TransportFailure>(error)) return false;
  // Without a reply since the last time, connecting again could go on forever.
  if (std::exchange(replies_at_reopen_, link_.replies()) == link_.replies()) return false;
  return connect_only().has_value();
}

Result<> Device::connect_only() {
  link_.close();
  return link_.connect();
}

Result<> Device::connect_again() {
  Result<> result = connect_only();
  if (result && verify_ != Verify::off) result = prove_equal();
  if (result && is_node_) result = fail(NotConnected{"another device answers at its address"});
  if (result) result = watchdog_.connected();
  replies_at_connect_ = link_.replies();
  if (result && poller_.last_answered()) result = link_.ask(*poller_.last_answered());
  return result;
}

Result<> Device::serve_watchdog() {
  const Result<bool> is_back = watchdog_.step();
  if (!is_back) return tl::make_unexpected(is_back.error());
  return *is_back ? writer_.reconnected() : Result<>{};
}

Time Device::due() const {
  const Time read_due = listener_.lets_read() ? poller_.due() : Time::max();
  return std::min({writer_.due(), watchdog_.due(), scheduler_.due(listener_), read_due, listener_.due(),
                   keep_alive_due()});
}

void Device::arrived() {
  if (writer_.awaits_answer()) return;
  if (!is_verified()) {  // the unit was away, and now the gateway is, too
    link_.close();
    note(DeviceEvent::lost);
    return;
  }
  if (listener_.is_waiting()) {
    if (const auto heard = listener_.receive(); !heard)
      lost(heard.error());
    else
      answered();
    return;
  }
  const auto discarded = link_.discard_unasked();
  if (discarded) return;
  if (!only_looks_ || is_node_) return lost(discarded.error());
  link_.close();  // some devices do so when nothing is asked
  is_closed_ = true;
}

bool Device::stop() {
  const bool is_safe = writer_.shut_down(is_verified());  // first: there may be little time
  if (scheduler_.is_busy() && writer_.awaits_answer()) writer_.step();
  scheduler_.shut_down(is_verified(), listener_);
  writer_.disconnected(NotConnected{"the driver ends"});
  scheduler_.disconnected("the driver ends");
  watchdog_.disconnected("the driver ends");
  link_.close();
  values_.online(false);
  if (note(DeviceEvent::lost) == State::online) sink_.on_online(false);
  return is_safe;
}

Time Device::connect() {
  link_.rank(Rank::read);
  wrote_last_ = is_closed_ = false;
  node_ = {};
  is_node_ = false;
  Result<> result = state_ == State::open ? Result<>{} : link_.connect();
  if (result) note(DeviceEvent::connected);
  if (result && verify_ != Verify::off) result = prove_equal();
  writer_.talks_to_node(is_node_ || map_.connection.tls.present());
  if (result) result = watchdog_.connected();
  if (result && writer_.has_suspects() && poller_.last_answered())
    result = link_.ask(*poller_.last_answered());
  if (result) result = writer_.reconnected();
  if (!result) {
    lost(result.error());
    return retry_at_;
  }
  note(DeviceEvent::verified);
  listen();
  scheduler_.connected(listener_.is_active() && node_.functions.schedules_outputs);
  poller_.start(is_node_ || map_.connection.tls.present(), listener_.is_active());
  replies_at_connect_ = link_.replies();
  const bool has_nothing_to_read = only_looks_ && poller_.due() == Time::max();
  if (has_nothing_to_read || map_.connection.is_broadcast() || (verify_ != Verify::off && identity_suffices_))
    came_online();
  if (has_nothing_to_read) cycle_ended();
  return due();
}

void Device::listen() {
  const bool tells = map_.changes && node_.functions.tells_changes && link_.can_wait();
  const bool lets_waits_through = unheard_waits_ < most_unheard_waits;
  if (tells && lets_waits_through)
    listener_.start(std::chrono::milliseconds(node_.watchdog_timeout));
  else
    listener_.stop();
  if (!tells || lets_waits_through) return;
  sink_.on_note(
      Level::warning,
      "the device says that it reports changes, but the question for them (function code 65) ended the "
      "last two connections that it was sent on; its points are polled while this connection lasts. Where a "
      "gateway does not let the question through, say so in the map: changes: off");
}

Result<> Device::ask_for_watchdog() {
  const Result<identity::Further> further = read_further(link_);
  if (!further) return tl::make_unexpected(further.error());
  listener_.set_watchdog(std::chrono::milliseconds(further->watchdog_timeout));
  return {};
}

void Device::came_online() {
  if (note(DeviceEvent::answered) == State::online) return;
  if (!only_looks_) backoff_.reset();
  last_error_kind_.clear();
  const auto certificates = link_.certificates();
  statistics_.online(certificates);
  values_.online(true);
  sink_.on_online(true);
  const std::string connected = peer_.empty() ? "connected" : "connected to " + peer_;
  if (const std::uint64_t dropped = writer_.take_dropped(); dropped > 0)
    tell(Level::warning, fmt::format("{}; {} writes were dropped meanwhile", connected, dropped));
  else
    tell(Level::info, connected);
  if (const Health health = certificates_health(certificates, std::chrono::system_clock::now());
      health.level != Level::info)
    sink_.on_report(health.level, health.text);
}

void Device::tell(Level level, std::string text) {
  level_ = level;
  const auto line = lines_.say(std::move(text), clock_.now());
  holds_line_ = !line;
  if (line) sink_.on_report(level, *line);
}

void Device::tell_what_waits() {
  const auto line = lines_.due(clock_.now());
  holds_line_ = lines_.due_at().has_value();
  if (line) sink_.on_report(level_, *line);
}

}  // namespace coupler::host
