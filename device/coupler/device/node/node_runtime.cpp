// SPDX-License-Identifier: Apache-2.0
#include "coupler/device/node/node_runtime.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <optional>
#include <utility>

#include "coupler/device/analogue/open_channels.hpp"
#include "coupler/device/analogue/sampler.hpp"
#include "coupler/device/node/io_service.hpp"
#include "coupler/device/node/realtime.hpp"
#include "coupler/device/node/servable.hpp"
#include "coupler/device/node/this_machine.hpp"
#include "coupler/map/fingerprint.hpp"

namespace coupler::device {
namespace {

/// Clients need not notice the change from one to the other.
bool looks_the_same(const ServingContext& a, const ServingContext& b) {
  return a.map->fingerprint == b.map->fingerprint && a.map->connection.unit == b.map->connection.unit &&
         a.address == b.address && a.port == b.port;
}

}  // namespace

void tell(Log& log, const Refusal& refusal) {
  for (std::string_view errors = refusal.errors; !errors.empty();) {
    const auto end = std::min(errors.find('\n'), errors.size());
    log.fail(fmt::format("error: {}", errors.substr(0, end)));
    errors.remove_prefix(std::min(end + 1, errors.size()));
  }
}

NodeRuntime::NodeRuntime(Loop& loop, const Options& options, ReadMap again, ServiceManager& manager, Log& log,
                         Hooks* hooks)
    : loop_(loop),
      options_(options),
      again_(std::move(again)),
      manager_(manager),
      log_(log),
      firmware_(hooks),
      machine_(this_machine()) {}

tl::expected<void, Refusal> NodeRuntime::start(const Map& map) {
  if (firmware_ != nullptr) hooks_ = std::make_unique<GuardedHooks>(*firmware_, map, log_);
  auto first = prepare(map, nullptr);
  if (!first) return tl::unexpected(std::move(first).error());
  context_ = *std::move(first);
  if (context_->analogue && !context_->analogue->drive_all(false))
    return tl::unexpected(
        Refusal{Refusal::device_failed, "not every analogue output can be driven to its initial value"});
  context_->wiring = std::exchange(context_->prepared, nullptr)->take_over();
  manager_.set_status(status_line());
  return {};
}

/// The network and channels first: outputs are not touched by a program that then cannot serve them. To
/// request a line drives it; to open a channel does not.
tl::expected<std::unique_ptr<ServingContext>, Refusal> NodeRuntime::prepare(const Map& map, MapPtr owner) {
  if (auto servable = check_servable(map); !servable)
    return tl::unexpected(Refusal{Refusal::map_is_wrong, std::move(servable).error()});
  auto guests = allow_list_of(map);
  if (!guests) return tl::unexpected(Refusal{Refusal::map_is_wrong, std::move(guests).error()});

  auto context = std::make_unique<ServingContext>();
  context->owner = std::move(owner);
  context->map = &map;
  context->address = address_for(map, options_);
  context->port = options_.port.value_or(map.connection.port);
  auto listener = listen(context->address, context->port);
  if (!listener) return tl::unexpected(Refusal{Refusal::device_failed, std::move(listener).error()});
  context->listener = *std::move(listener);
  context->listener.guests = *std::move(guests);
  context->state = std::make_unique<SharedState>(map, TimePoint::clock::now(), machine_);
  if (context_) context->state->prepare_take_over(*context_->state);
  if (!options_.simulated) {
    auto channels = open_channels(map, log_);
    if (!channels) return tl::unexpected(Refusal{Refusal::device_failed, std::move(channels).error()});
    context->channels = *std::move(channels);
  }
  if (context->channels)
    context->analogue = std::make_unique<AnaloguePoints>(map, context->state->image(), *context->channels);
  if (hooks_) context->hooked = std::make_unique<HookedPoints>(map, context->state->image(), *hooks_);
  const bool safe = context_ && context_->has_expired() && map.service.watchdog.present();
  auto wiring =
      prepare_wiring(map, options_.simulated, context_ ? context_->wiring.get() : nullptr, safe, log_);
  if (!wiring) return tl::unexpected(Refusal{Refusal::device_failed, std::move(wiring).error()});
  context->prepared = *std::move(wiring);
  return context;
}

tl::expected<Listener, std::string> NodeRuntime::listen(const std::string& address, std::uint16_t port) {
  if (context_ && context_->address == address && context_->port == port) return context_->listener.share();
  auto listener = listen_on(address, port);
  if (!listener && context_ && context_->port == port)
    return tl::unexpected(listener.error() +
                          "; this node listens on that port, and can change the address alone only when it "
                          "is started anew");
  return listener;
}

std::string NodeRuntime::status_line() const {
  const Map& map = *context_->map;
  return fmt::format("serving {} ({} point{}, fingerprint {}) on {}{}", map.name, map.points.size(),
                     map.points.size() == 1 ? "" : "s", fingerprint_text(map.fingerprint),
                     context_->listener.name, options_.simulated ? ", simulated" : "");
}

int NodeRuntime::serve(SupervisorLink& supervisor, std::vector<OpenConnection> clients) {
  if (options_.realtime)
    if (const auto had = become_realtime(RealtimePriority::io_process); !had) {
      tell(log_, {Refusal::device_failed, had.error()});
      return Refusal::device_failed;
    }
  Loop loop;
  if (!loop.is_open()) {
    tell(log_, {Refusal::device_failed, std::strerror(errno)});
    return Refusal::device_failed;
  }
  const Signals signals(loop);
  supervisor.watch(loop);
  if (hooks_ && !hooks_->begin()) return Refusal::device_failed;
  std::optional<Sampler> sampler;
  if (context_->channels)
    sampler.emplace(*context_->channels, Sampler::period_for(context_->map->polling.rate));
  IoService service(*context_, loop, log_);
  service.take_over(std::move(clients));
  service.run(
      [&](TimePoint now) {
        return signals.stop() != 0 || supervisor.wants_room() || supervisor.is_silent(now);
      },
      supervisor);
  if (signals.stop() != 0)
    service.end(signals.stop());
  else if (supervisor.wants_room())
    for (const OpenConnection& client : service.release()) supervisor.give(client);
  else
    return end_without_keeper(service);
  return 0;
}

void NodeRuntime::beat() {
  if (!std::exchange(has_announced_, true)) log_.write(status_line());
  manager_.beat();
}

/// Were this process to die now, nobody would drive the outputs. Whoever started the node starts it again.
int NodeRuntime::end_without_keeper(IoService& service) {
  const bool safe = service.make_safe();
  log_.fail(fmt::format(
      "the supervisor, process {}, was silent for {} s and is killed; {}", ::getppid(),
      SupervisorLink::timeout.count(),
      safe ? "outputs are in their safe state" : "not every output could be driven to its safe state"));
  ::kill(::getppid(), SIGKILL);
  return Refusal::device_failed;
}

void NodeRuntime::reload(pid_t asker) {
  askers_.add(asker);
  if (!again_.read) {
    const auto why =
        "SIGHUP: the map of this node is built in or came through standard input; there is nothing to read "
        "again";
    log_.write(why);
    askers_.tell(false, why);
    return;
  }
  const TimePoint now = TimePoint::clock::now();
  manager_.reloading(now);
  // What is being read may have been changed since: it is read once more.
  begin_reading(now);
}

void NodeRuntime::begin_reading(TimePoint now) {
  reading_ = nullptr;
  auto reading = MapReading::start(loop_, again_, now);
  if (reading)
    reading_ = *std::move(reading);
  else
    refuse({Refusal::device_failed, std::move(reading).error()});
}

bool NodeRuntime::look_after(TimePoint now) {
  former_ = nullptr;
  const bool taken = reading_ != nullptr && reading_->is_over(now) && take_map();
  return mend(now) || taken;
}

bool NodeRuntime::take_map() {
  auto map = std::exchange(reading_, nullptr)->take();
  if (!map) {
    refuse({Refusal::map_is_wrong, std::move(map).error()});
    return false;
  }
  auto next = prepare((*map)->map(), *map);
  if (!next) {
    refuse(next.error());
    return false;
  }
  next_ = *std::move(next);
  return true;
}

void NodeRuntime::refuse(const Refusal& refusal) {
  tell(log_, refusal);
  const std::string text = fmt::format("the new map is refused; the old one goes on: {}", status_line());
  log_.fail(text);
  askers_.tell(false, text);
  manager_.ready(status_line());
}

/// Chips that were unplugged and are back, once a second.
bool NodeRuntime::mend(TimePoint now) {
  if (now < next_look_) return false;
  next_look_ = now + std::chrono::seconds(1);
  const bool safe = context_->has_expired();
  const bool lines = context_->wiring->mend(safe);
  const bool channels = context_->mend_channels(safe);
  return lines || channels;
}

void NodeRuntime::change(std::vector<OpenConnection>& clients) {
  if (!next_) return;
  const bool same = looks_the_same(*context_, *next_);
  next_->state->take_over(*context_->state, TimePoint::clock::now());
  next_->wiring = std::exchange(next_->prepared, nullptr)->take_over();
  if (context_->channels) context_->channels->hand_over(next_->channels.get());
  // Outputs that both have keep their value, which was carried over; what fails says so.
  const bool safe = next_->has_expired();
  if (next_->analogue) (void)next_->analogue->drive_all(safe);
  // It may have expired since the new lines were requested.
  if (safe) next_->state->watchdog().expire(next_->hardware().drive_safe(), TimePoint::clock::now());
  if (!same) clients.clear();
  // To free what a large map had takes its time, and clients wait.
  former_ = std::exchange(context_, std::exchange(next_, nullptr));
  const std::string text =
      fmt::format("read the map again: {}{}", status_line(), same ? "" : "; clients have to connect again");
  log_.write(text);
  askers_.tell(true, text);
  manager_.ready(status_line());
}

bool NodeRuntime::drive_safe() {
  // A process that is made for this has ordinary priority, and only a second. In the supervisor nothing
  // changes.
  if (options_.realtime) (void)take_priority(RealtimePriority::supervisor);
  const bool safe = Hardware(context_->wiring->lines(), context_->analogue.get()).drive_safe();
  context_->state->watchdog().disarm();
  return safe;
}

bool NodeRuntime::make_firmware_safe() { return hooks_->end(context_->state->image()); }

}  // namespace coupler::device
