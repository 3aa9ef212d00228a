// SPDX-License-Identifier: Apache-2.0
#include "coupler/device/node/node_runtime.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <utility>

#include "coupler/device/node/realtime.hpp"
#include "coupler/map/fingerprint.hpp"
#include "coupler/map/rights_text.hpp"

namespace coupler::device {
namespace {

ServeError error_of(const TlsProcess::Answer& answer) {
  return {answer.has_failed ? ServeError::device_failed : ServeError::map_is_wrong, answer.problem};
}

}  // namespace

NodeRuntime::NodeRuntime(Loop& loop, const Options& options, ReadMap again, ServiceManager& manager, Log& log,
                         Hooks* hooks)
    : loop_(loop),
      options_(options),
      again_(std::move(again)),
      manager_(manager),
      log_(log),
      firmware_(hooks) {}

tl::expected<void, ServeError> NodeRuntime::start(const Map& map, Descriptor settings) {
  if (firmware_ != nullptr) hooks_ = std::make_unique<GuardedHooks>(*firmware_, map, log_);
  auto first = ServingContext::prepare(map, nullptr, options_, nullptr, hooks_.get(), log_);
  if (!first) return tl::unexpected(std::move(first).error());
  context_ = *std::move(first);
  if (context_->tls_listener) {
    if (auto prepared = prepare_tls(std::move(settings)); !prepared) return prepared;
    for (TimePoint now = TimePoint::clock::now(); awaits_tls_;) {
      now = loop_.run_once(std::chrono::milliseconds(100));
      if (const auto answer = next_tls_->answer(now)) {
        if (!answer->problem.empty()) return tl::unexpected(error_of(*answer));
        awaits_tls_ = false;
      }
    }
    tls_ = std::move(next_tls_);
    tls_->commit(context_->tls_listener->socket.get());
  }
  if (context_->analogue && !context_->analogue->drive_all(false))
    return tl::unexpected(
        ServeError{ServeError::device_failed,
                   "not every analogue output can be driven to its initial value; the line before names "
                   "it, or a DAC does not take the value of 'initial' at its point"});
  context_->wiring = std::exchange(context_->prepared, nullptr)->take_over();
  manager_.set_status(status_line());
  return {};
}

std::string NodeRuntime::status_line() const {
  const Map& map = *context_->map;
  const auto& tls = context_->tls_listener;
  return fmt::format("serving {} ({} point{}, fingerprint {}) on {}{}{}", map.name, map.points.size(),
                     map.points.size() == 1 ? "" : "s", fingerprint_text(map.fingerprint),
                     context_->listener.name, tls ? ", TLS at " + tls->name : "",
                     options_.simulated ? ", simulated" : "");
}

int NodeRuntime::serve(SupervisorLink& supervisor, std::vector<OpenConnection> clients) {
  if (options_.realtime)
    if (const auto had = become_realtime(RealtimePriority::worker); !had) {
      log_errors(log_, {ServeError::device_failed, had.error()});
      return ServeError::device_failed;
    }
  // The key is for another process.
  for (TlsProcess* process : {tls_.get(), next_tls_.get()})
    if (process != nullptr) process->leave();
  if (reading_ != nullptr) reading_->leave();
  // It takes time to free a large map, and clients wait: only what others may want is given up.
  for (ServingContext* other : {former_.get(), next_.get()})
    if (other != nullptr) other->leave();
  Loop loop;
  if (!loop.is_open()) {
    log_errors(log_, {ServeError::device_failed, std::strerror(errno)});
    return ServeError::device_failed;
  }
  const Signals signals(loop);
  supervisor.watch(loop);
  if (hooks_) waker_ = std::make_unique<LoopWaker>(loop);
  if (context_->channels)
    sampler_ =
        std::make_unique<Sampler>(*context_->channels, Sampler::period_for(context_->map->polling.rate));
  IoService service(*context_, loop, log_, tls_ ? tls_->clients() : -1);
  if (hooks_ && !hooks_->begin(waker_.get())) return ServeError::device_failed;  // it may ask for levels
  service.take_over(std::move(clients));
  service.run(
      [&](TimePoint now) {
        return signals.stop() != 0 || supervisor.wants_room() || supervisor.is_silent(now);
      },
      [&] { supervisor.beat(); });
  if (signals.stop() != 0)
    service.end(why_it_ends(signals.stop(), supervisor.pid()));
  else if (supervisor.wants_room())
    for (const OpenConnection& client : service.release()) supervisor.give(client);
  else
    return end_without_supervisor(service);
  return 0;
}

/// The kernel sends a signal, too, if the parent has been killed.
std::string NodeRuntime::why_it_ends(int signal, pid_t supervisor) const {
  if (::getppid() != supervisor)
    return fmt::format("the supervisor, process {}, was killed, and the node ends with it", supervisor);
  if (hooks_)
    if (const std::string_view why = hooks_->why_it_ends(); !why.empty()) return std::string(why);
  return ::strsignal(signal);
}

void NodeRuntime::beat() {
  if (!std::exchange(has_announced_, true)) {
    log_.write(status_line());
    warn_of_open_outputs();
  }
  manager_.beat();
}

/// Somebody who limits what can be written, but leaves some of it to everybody, should know that.
void NodeRuntime::warn_of_open_outputs() {
  const Security& security = context_->map->security;
  const Role* role = security.plain_role();
  if (role == nullptr) return;
  const auto may = [&](const Point& point) {
    return is_writable(point) &&
           role->may(Right::write, static_cast<std::size_t>(&point - context_->map->points.begin()));
  };
  const auto count = std::count_if(context_->map->points.begin(), context_->map->points.end(), may);
  if (count > 0)
    log_.warn(fmt::format("{} may write {} point{}, as {}; `coupler check` shows which",
                          plain_clients(security), count, count == 1 ? "" : "s", role->name));
}

/// If this process died later, nobody would drive the outputs. What started the node starts it again.
int NodeRuntime::end_without_supervisor(IoService& service) {
  const bool safe = service.make_safe(modbus::Reason::safe_state);
  log_.fail(fmt::format(
      "the supervisor, process {}, was silent for {} s and is killed; {}", ::getppid(),
      SupervisorLink::timeout.count(),
      safe ? "outputs are in their safe state" : "not every output could be driven to its safe state"));
  ::kill(::getppid(), SIGKILL);
  return ServeError::device_failed;
}

void NodeRuntime::reload(pid_t requester) {
  requests_.add(requester);
  if (!again_.reads_something()) {
    const auto why =
        "SIGHUP is ignored: the map of this node is built in or came through standard input, so it cannot be "
        "read again";
    log_.write(why);
    requests_.reply(false, why);
    return;
  }
  const TimePoint now = TimePoint::clock::now();
  manager_.reloading(now);
  // A file that is being read may have been changed since, so it is read once more.
  begin_reading(now);
}

void NodeRuntime::begin_reading(TimePoint now) {
  reading_ = nullptr;
  next_ = nullptr;  // what was read before, and waits for the process that does TLS
  next_tls_ = nullptr;
  awaits_tls_ = false;
  auto reading = MapReading::start(loop_, again_, now);
  if (reading)
    reading_ = *std::move(reading);
  else
    refuse(reading.error());
}

bool NodeRuntime::look_after(TimePoint now) {
  former_ = nullptr;
  if (tls_) tls_->look_after(now);
  const bool is_read = reading_ != nullptr && reading_->is_over(now);
  if (is_read) next_look_ = now;  // lines that are back are kept, and not begun with
  const bool reconnected = reconnect(now);
  if (reconnected && next_) {
    log_.write("lines have come or gone since the new map was read: it is read once more");
    begin_reading(now);
    return true;
  }
  const bool taken = is_read && take_map();
  const bool is_ready = (taken && !awaits_tls_) || tls_is_ready(now);
  return reconnected || is_ready;
}

bool NodeRuntime::take_map() {
  auto read = std::exchange(reading_, nullptr)->take();
  if (!read) {
    refuse(read.error());
    return false;
  }
  if (read->map) {
    auto next =
        ServingContext::prepare(read->map->map(), read->map, options_, context_.get(), hooks_.get(), log_);
    if (!next) {
      refuse(next.error());
      return false;
    }
    next_ = *std::move(next);
    if (!next_->tls_listener) return true;
  }
  if (const auto prepared = prepare_tls(std::move(read->settings)); !prepared) {
    next_ = nullptr;
    refuse(prepared.error());
    return false;
  }
  return true;
}

/// The process that does TLS looks at the settings: awaits_tls_.
tl::expected<void, ServeError> NodeRuntime::prepare_tls(Descriptor settings) {
  if (!tls_) {
    auto process = TlsProcess::start(loop_, log_);
    if (!process) return tl::unexpected(ServeError{ServeError::device_failed, std::move(process).error()});
    next_tls_ = *std::move(process);
  }
  (tls_ ? tls_ : next_tls_)->prepare(std::move(settings));
  awaits_tls_ = true;
  return {};
}

/// It has: what was read can come into force. What it refuses is logged.
bool NodeRuntime::tls_is_ready(TimePoint now) {
  if (!awaits_tls_) return false;
  const auto answer = (tls_ ? tls_ : next_tls_)->answer(now);
  if (!answer) return false;
  awaits_tls_ = false;
  if (answer->problem.empty() && next_) return true;
  if (!answer->problem.empty()) {
    next_ = nullptr;
    next_tls_ = nullptr;
    refuse(error_of(*answer));
    return false;
  }
  // A map that is built in stays as it is.
  tls_->commit(context_->tls_listener->socket.get());
  const std::string text = "read the certificates again: " + status_line();
  log_.write(text);
  requests_.reply(true, text);
  manager_.ready(status_line());
  return false;
}

void NodeRuntime::refuse(const ServeError& error) {
  log_errors(log_, error);
  const std::string text =
      fmt::format("the new map is refused; the old one stays in force: {}", status_line());
  log_.fail(text);
  requests_.reply(false, (error.errors.empty() ? error.first_logged : error.errors) + "; " + text);
  manager_.ready(status_line());
}

/// Looks once a second for chips that were unplugged, or plugged in again.
bool NodeRuntime::reconnect(TimePoint now) {
  if (now < next_look_) return false;
  next_look_ = now + std::chrono::seconds(1);
  const bool safe = context_->has_expired();
  const bool lines = context_->wiring->reconnect(safe);
  const bool channels = context_->reconnect_channels(safe);
  return lines || channels;
}

void NodeRuntime::change(std::vector<OpenConnection>& clients) {
  context_->wiring->settle();
  if (!next_ || awaits_tls_) return;  // what was read may still be refused
  const bool same = next_->looks_like(*context_);
  end_durations_that_do_not_fit();
  next_->state->take_over(*context_->state, TimePoint::clock::now());
  next_->wiring = std::exchange(next_->prepared, nullptr)->take_over();
  if (context_->channels) context_->channels->hand_over(next_->channels.get());
  // Outputs that both maps have keep their value, which was taken over; what fails is logged.
  const bool safe = next_->has_expired();
  if (next_->analogue) (void)next_->analogue->drive_all(safe);
  // It may have expired since the new lines were requested.
  if (safe) next_->state->watchdog().expire(next_->hardware().drive_safe(), TimePoint::clock::now());
  if (!same) clients.clear();
  if (next_tls_) tls_ = std::move(next_tls_);
  if (!next_->tls_listener) tls_ = nullptr;
  if (tls_) tls_->commit(next_->tls_listener->socket.get());
  // It takes time to free a large map, and clients wait: it is done later.
  former_ = std::exchange(context_, std::exchange(next_, nullptr));
  const std::string text =
      fmt::format("read the map again: {}{}", status_line(), same ? "" : "; clients have to connect again");
  log_.write(text);
  warn_of_open_outputs();
  requests_.reply(true, text);
  manager_.ready(status_line());
}

}  // namespace coupler::device
