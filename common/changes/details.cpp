// SPDX-License-Identifier: Apache-2.0
#include "common/changes/details.hpp"

#include <chrono>

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <fmt/ranges.h>

namespace coupler::changes {
namespace {

constexpr auto compatible = Severity::compatible;
constexpr auto documentation = Severity::documentation;

std::string joined(Span<const std::uint16_t> registers) {
  return fmt::format("[{}]", fmt::join(registers.begin(), registers.end(), ", "));
}

std::string_view text_of(Safe safe) {
  switch (safe) {
    case Safe::off: return "off";
    case Safe::on: return "on";
    case Safe::hold: return "hold";
  }
  return "?";
}

std::string_view text_of(Edge edge) {
  switch (edge) {
    case Edge::rising: return "rising";
    case Edge::falling: return "falling";
    case Edge::both: return "both";
  }
  return "?";
}

std::string_view text_of(Bias bias) {
  switch (bias) {
    case Bias::as_is: return "";
    case Bias::none: return ", bias none";
    case Bias::pull_up: return ", bias pull_up";
    case Bias::pull_down: return ", bias pull_down";
  }
  return "?";
}

std::string_view text_of(Drive drive) {
  switch (drive) {
    case Drive::push_pull: return "";
    case Drive::open_drain: return ", drive open_drain";
    case Drive::open_source: return ", drive open_source";
  }
  return "?";
}

std::string text_of(const Line& line) {
  if (!line.present()) return {};
  return fmt::format(
      "{}{}{}{}{}", line.name.empty() ? fmt::format("{} {}", line.chip, line.offset) : std::string(line.name),
      line.active_low ? ", active_low" : "", text_of(line.bias), text_of(line.drive),
      line.debounce.count() > 0 ? fmt::format(", debounce {}", line.debounce) : "");
}

std::string text_of(const EdgeOf& edge) {
  return edge.present() ? fmt::format("{} edges of {}", text_of(edge.edge), edge.input) : "";
}

std::string text_of(const Iio& iio) {
  return iio.present() ? fmt::format("{} {}", iio.device, iio.channel) : "";
}

std::string text_of(const Pwm& pwm) {
  return pwm.present() ? fmt::format("{} {}, period {}", pwm.chip, pwm.channel, pwm.period) : "";
}

std::string safe_text(const Point& point) {
  const bool has_value = point.safe == Safe::on && !point.safe_value.empty();
  return has_value ? joined(point.safe_value) : std::string(text_of(point.safe));
}

/// Nothing said and zeroes said are the same.
std::string initial_text(const Point& point) {
  for (const std::uint16_t word : point.initial)
    if (word != 0) return joined(point.initial);
  return "0";
}

std::string publish_text(const HostOptions& host) {
  if (host.publish == HostOptions::Publish::always) return "always";
  return fmt::format("on_change, deadband {}, max_interval {}", host.deadband, host.max_interval);
}

std::string write_text(const HostOptions& host) {
  constexpr std::string_view functions[] = {"automatic", "single", "multiple"};
  return fmt::format("function {}, queue {}{}", functions[static_cast<std::size_t>(host.write_function)],
                     host.write_queue == HostOptions::WriteQueue::latest ? "latest" : "every",
                     host.verify_write ? ", verified" : "");
}

std::string deadman_text(const HostOptions& host) {
  return host.deadman.present() ? fmt::format("{} after {}", joined(host.deadman.value), host.deadman.timeout)
                                : "";
}

std::string polling_text(const Polling& polling) {
  return fmt::format("discrete_read_continuous {}, gap {}; registers_read_continuous {}, gap {}",
                     polling.discrete_continuous, polling.discrete_gap, polling.register_continuous,
                     polling.register_gap);
}

std::string limits_text(const Limits& limits) {
  return fmt::format(
      "read {} registers, {} bits; write {} registers, {} bits; request_gap {}, connect_delay {}; "
      "connections {}; mask_write {}",
      limits.read_registers, limits.read_bits, limits.write_registers, limits.write_bits, limits.request_gap,
      limits.connect_delay, limits.connections, limits.mask_write);
}

std::string unreadable_text(const Map& map) {
  std::string text;
  for (const Unreadable& area : map.unreadable)
    text += fmt::format("{}{} {}-{}", text.empty() ? "" : ", ", to_string(area.table), area.range.start(),
                        area.range.last());
  return text;
}

std::string watchdog_text(const Watchdog& watchdog) {
  if (!watchdog.present()) return {};
  return fmt::format("{}, fed by {}, {} recovery", watchdog.timeout,
                     watchdog.fed_by == Watchdog::FedBy::any ? "any" : "write",
                     watchdog.recovery == Watchdog::Recovery::automatic ? "automatic" : "manual");
}

std::string watchdog_text(const WatchdogSequences& watchdog) {
  if (!watchdog.present()) return {};
  std::string fed_by = "any request";
  if (!watchdog.feed.empty())
    fed_by = fmt::format("{} {}", to_string(watchdog.feed[0].table), watchdog.feed[0].address);
  return fmt::format("{}, fed by {}, {} recovery", watchdog.timeout, fed_by,
                     watchdog.recovery == Watchdog::Recovery::automatic ? "automatic" : "manual");
}

std::string sim_text(const Map& map) {
  std::string text;
  for (const SimWire& wire : map.sim)
    text += fmt::format("{}{} to {}{}", text.empty() ? "" : ", ",
                        wire.from.empty() ? fmt::format("square {}", wire.square) : std::string(wire.from),
                        wire.to, wire.invert ? " inverted" : "");
  return text;
}

}  // namespace

std::vector<Detail> details_of(const Point& point) {
  const HostOptions& host = point.host;
  return {
      {"description-changed", documentation, std::string(point.description)},
      {"units-changed", documentation, std::string(point.units)},
      {"initial-changed", compatible, initial_text(point)},
      {"safe-changed", compatible, safe_text(point)},
      {"line-changed", compatible, text_of(point.line)},
      {"counter-changed", compatible, text_of(point.counter)},
      {"latched-changed", compatible, text_of(point.latched)},
      {"iio-changed", compatible, text_of(point.iio)},
      {"pwm-changed", compatible, text_of(point.pwm)},
      {"read-address-changed", compatible, point.read_address ? fmt::to_string(*point.read_address) : ""},
      {"rate-changed", compatible, host.rate > 0 ? fmt::format("{} Hz", host.rate) : ""},
      {"publish-changed", compatible, publish_text(host)},
      {"latch-changed", compatible, fmt::to_string(host.latch)},
      {"queue-size-changed", compatible, fmt::to_string(host.queue_size)},
      {"write-changed", compatible, write_text(host)},
      {"deadman-changed", compatible, deadman_text(host)},
  };
}

std::vector<Detail> details_of(const Map& map) {
  const Connection& connection = map.connection;
  const Service& service = map.service;
  return {
      {"name-changed", compatible, std::string(map.name)},
      {"connection-changed", compatible,
       fmt::format("{} port {} unit {}, timeout {}", connection.address, connection.port, connection.unit,
                   connection.timeout)},
      {"map-rate-changed", compatible, fmt::format("{} Hz", map.polling.rate)},
      {"polling-changed", compatible, polling_text(map.polling)},
      {"limits-changed", compatible, limits_text(map.limits)},
      {"unreadable-changed", compatible, unreadable_text(map)},
      {"on-reconnect-changed", compatible, map.on_reconnect == OnReconnect::drop ? "drop" : "restore"},
      {"on-shutdown-changed", compatible, map.on_shutdown == OnShutdown::hold ? "hold" : "safe"},
      {"poll-changed", compatible, map.poll == Poll::all ? "all" : "subscribed"},
      {"listen-changed", compatible, std::string(service.listen)},
      {"allow-changed", compatible,
       fmt::format("{}", fmt::join(service.allow.begin(), service.allow.end(), ", "))},
      {"watchdog-changed", compatible, watchdog_text(service.watchdog)},
      {"coupler-watchdog-changed", compatible, watchdog_text(map.coupler_watchdog)},
      {"readback-changed", compatible, fmt::to_string(service.readback)},
      {"sim-changed", compatible, sim_text(map)},
  };
}

}  // namespace coupler::changes
