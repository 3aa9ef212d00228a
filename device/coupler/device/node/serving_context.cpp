// SPDX-License-Identifier: Apache-2.0
#include "coupler/device/node/serving_context.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <utility>

#include "coupler/codec/number.hpp"
#include "coupler/device/core/image.hpp"
#include "coupler/device/net/allow_list.hpp"
#include "coupler/device/node/this_machine.hpp"
#include "coupler/map/identity.hpp"

namespace coupler::device {
namespace {

/// Channels without hardware (`--sim`): outputs take what a PWM, or a DAC that tells no limits, takes, and
/// inputs have the value that the image has, which the field side sets.
class SimulatedChannels final : public Channels {
 public:
  /// The image outlives it.
  explicit SimulatedChannels(const Image& image) : image_(image) {}

  std::optional<double> read(const Point& input, TimePoint) override {
    return codec::published(image_.find(input.table, range(input)).data(), input.format, input.scale);
  }
  bool accepts(const Point& output, double value) const override {
    return !output.pwm.present() || is_duty_cycle(value);
  }
  Outcome drive(const Point&, double) override { return Outcome::done; }

 private:
  const Image& image_;
};

/// The address at which the node before this one listened.
struct Before {
  const std::string& address;
  std::uint16_t port;
  const Listener& listener;
};

/// `before` may be null.
tl::expected<Listener, std::string> listen(const Before* before, const std::string& address,
                                           std::uint16_t port, const char* option) {
  if (before != nullptr && before->address == address && before->port == port)
    return before->listener.share();
  auto listener = listen_on(address, port, option);
  if (!listener && before != nullptr && before->port == port)
    return tl::unexpected(listener.error() +
                          "; this node already listens on that port: restart it to change only the address");
  return listener;
}

/// Opens the listeners of a context whose address and ports are known. The error says why one cannot be.
tl::expected<void, std::string> listen_all(ServingContext& context, const ServingContext* before) {
  std::optional<Before> plain;
  std::optional<Before> tls;
  if (before != nullptr) plain.emplace(Before{before->address, before->port, before->listener});
  if (before != nullptr && before->tls_listener)
    tls.emplace(Before{before->address, before->tls_port, *before->tls_listener});
  auto listener = listen(plain ? &*plain : nullptr, context.address, context.port, "--port");
  if (!listener) return tl::unexpected(std::move(listener).error());
  context.listener = *std::move(listener);
  if (!context.map->security.files.present()) return {};
  listener = listen(tls ? &*tls : nullptr, context.address, context.tls_port, "--tls-port");
  if (!listener) return tl::unexpected(std::move(listener).error());
  context.tls_listener = *std::move(listener);
  return {};
}

}  // namespace

tl::expected<std::unique_ptr<ServingContext>, ServeError> ServingContext::prepare(
    const Map& map, MapPtr owner, const Options& options, const ServingContext* before, Hooks* hooks,
    Log& log) {
  const auto failed = [](ServeError::Reason reason, std::string errors) {
    return tl::unexpected(ServeError{reason, std::move(errors)});
  };
  if (auto servable = check_servable(map); !servable)
    return failed(ServeError::map_is_wrong, std::move(servable).error());
  auto allowed = AllowList::of(map);
  if (!allowed) return failed(ServeError::map_is_wrong, std::move(allowed).error());

  auto context = std::make_unique<ServingContext>();
  context->owner = std::move(owner);
  context->map = &map;
  context->address = address_for(map, options);
  context->port = options.port.value_or(map.service.port);
  context->tls_port = options.tls_port.value_or(map.security.port);
  if (auto listens = listen_all(*context, before); !listens)
    return failed(ServeError::device_failed, std::move(listens).error());
  context->listener.allowed = *std::move(allowed);
  context->state = std::make_unique<SharedState>(
      map, TimePoint::clock::now(), before == nullptr ? this_machine() : before->state->machine());
  if (before != nullptr) context->state->prepare_take_over(*before->state, options.simulated);
  if (options.simulated && std::any_of(map.points.begin(), map.points.end(), is_analogue)) {
    context->simulated = std::make_unique<SimulatedChannels>(context->state->image());
    context->analogue = std::make_unique<AnaloguePoints>(map, context->state->image(), *context->simulated);
  }
  if (!options.simulated) {
    auto channels = open_channels(map, log, "/sys", before == nullptr ? first_udev_timeout : udev_timeout);
    if (!channels) return failed(ServeError::device_failed, std::move(channels).error());
    context->channels = *std::move(channels);
  }
  if (context->channels)
    context->analogue = std::make_unique<AnaloguePoints>(map, context->state->image(), *context->channels);
  if (hooks != nullptr)
    context->hooked = std::make_unique<HookedPoints>(map, context->state->image(), *hooks);
  const bool safe = before != nullptr && before->has_expired() && map.service.watchdog.present();
  auto wiring =
      prepare_wiring(map, options.simulated, before == nullptr ? nullptr : before->wiring.get(), safe, log);
  if (!wiring) return failed(ServeError::device_failed, std::move(wiring).error());
  context->prepared = *std::move(wiring);
  return context;
}

bool ServingContext::looks_like(const ServingContext& other) const {
  return map->fingerprint == other.map->fingerprint && map->connection.unit == other.map->connection.unit &&
         address == other.address && port == other.port;
}

bool ServingContext::reconnect_channels(bool safe) {
  if (!channels) return false;
  const auto reconnected = channels->reconnect();
  for (const Point* point : reconnected)
    if (is_writable(point->table)) (void)analogue->drive(*point, safe);
  return !reconnected.empty();
}

tl::expected<void, std::string> check_servable(const Map& map) {
  std::string errors;
  for (const Point& point : map.points) {
    if (holds_bits(point.table) || !range(point).overlaps(identity::reserved)) continue;
    errors += fmt::format(
        "{}point '{}': {} {} is in the area that every node keeps for its identity (0x{:04X} to 0x{:04X}); "
        "move it below",
        errors.empty() ? "" : "\n", point.name, to_string(point.table), point.address,
        identity::reserved.start(), identity::reserved.last());
  }
  if (!errors.empty()) return tl::unexpected(std::move(errors));
  return {};
}

}  // namespace coupler::device
