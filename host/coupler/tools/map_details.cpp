// SPDX-License-Identifier: Apache-2.0
#include "coupler/tools/map_details.hpp"

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "coupler/docs/words.hpp"
#include "coupler/map/fields.hpp"
#include "coupler/map/rights_text.hpp"

namespace coupler::tools {
namespace {

constexpr auto meaning = Severity::meaning;
constexpr auto compatible = Severity::compatible;
constexpr auto documentation = Severity::documentation;

std::string joined(Span<const std::uint16_t> registers) {
  return fmt::format("[{}]", fmt::join(registers.begin(), registers.end(), ", "));
}

std::string text_of(const Line& line) {
  if (!line.present()) return {};
  return fmt::format(
      "{}{}{}{}", line.name.empty() ? fmt::format("{} {}", line.chip, line.offset) : std::string(line.name),
      line.bias == Bias::as_is ? "" : fmt::format(", bias {}", to_string(line.bias)),
      line.drive == Drive::push_pull ? "" : fmt::format(", drive {}", to_string(line.drive)),
      line.debounce.count() > 0 ? fmt::format(", debounce {}", line.debounce) : "");
}

std::string text_of(const EdgeOf& edge) {
  return edge.present() ? fmt::format("{} edges of {}", to_string(edge.edge), edge.input) : "";
}

std::string text_of(const Iio& iio) {
  return iio.present() ? fmt::format("{} {}", iio.device, iio.channel) : "";
}

std::string text_of(const Pwm& pwm) {
  return pwm.present() ? fmt::format("{} {}, period {}", pwm.chip, pwm.channel, pwm.period) : "";
}

std::string safe_text(const Point& point) {
  const bool has_value = point.safe == Safe::on && !point.safe_value.empty();
  return has_value ? joined(point.safe_value) : std::string(to_string(point.safe));
}

/// No initial value and zeros are the same.
std::string initial_text(const Point& point) {
  for (const std::uint16_t word : point.initial)
    if (word != 0) return joined(point.initial);
  return "0";
}

std::string deadman_text(const HostOptions& host) {
  return host.deadman.present() ? fmt::format("{} after {}", joined(host.deadman.value), host.deadman.timeout)
                                : "";
}

std::string text_of(Span<const NamedValue> values) {
  std::string text;
  for (const NamedValue& named : values)
    text += fmt::format("{}{}: {}", text.empty() ? "" : ", ", named.value, named.name);
  return text;
}

std::string areas_text(Span<const TableRange> areas) {
  std::string text;
  for (const TableRange& area : areas)
    text += fmt::format("{}{} {}-{}", text.empty() ? "" : ", ", to_string(area.table), area.range.start(),
                        area.range.last());
  return text;
}

std::string watchdog_text(const WatchdogSequences& watchdog) {
  if (!watchdog.present()) return {};
  std::string fed_by = "any request";
  if (!watchdog.feed.empty())
    fed_by = fmt::format("{} {}", to_string(watchdog.feed[0].table), watchdog.feed[0].address);
  return fmt::format("{}, fed by {}, {} recovery", watchdog.timeout, fed_by, to_string(watchdog.recovery));
}

std::string sim_text(const Map& map) {
  std::string text;
  for (const SimWire& wire : map.sim)
    text += fmt::format("{}{} to {}{}", text.empty() ? "" : ", ",
                        wire.from.empty() ? fmt::format("square {}", wire.square) : std::string(wire.from),
                        wire.to, wire.invert ? " inverted" : "");
  return text;
}

/// The fields that differ from their defaults.
template <class Struct>
std::string given_fields(const Struct& object) {
  std::string text;
  for_each_field(object, Struct{}, [&](const auto& field, const auto& value, const auto& usual) {
    if (value != usual) text += fmt::format("{}{} {}", text.empty() ? "" : ", ", field.key, written(value));
  });
  return text;
}

std::string security_text(const Map& map) {
  std::string text;
  for (const Role& role : map.security.roles)
    text += fmt::format("{}{} reads {}, writes {}", text.empty() ? "" : "; ", role.name,
                        rights_text(map, role, Right::read), rights_text(map, role, Right::write));
  if (!map.security.present()) return text;
  const auto name_of = [&](std::optional<std::uint16_t> role) {
    return role ? map.security.roles[*role].name : "nobody";
  };
  text += fmt::format("; {}: {}", plain_clients(map.security), name_of(map.security.plain));
  const CredentialFiles& files = map.security.files;
  if (!files.present()) return text;
  return text + fmt::format("; without a role: {}; TLS at port {} with {}, {}, {}{}{}",
                            name_of(map.security.no_role), map.security.port, files.certificate, files.key,
                            files.ca, files.revoked.empty() ? "" : ", ", files.revoked);
}

}  // namespace

std::vector<Detail> details_of(const Point& point) {
  return {
      {"description-changed", documentation, std::string(point.description)},
      {"units-changed", meaning, std::string(point.units)},
      {"initial-changed", compatible, initial_text(point)},
      {"safe-changed", compatible, safe_text(point)},
      {"line-changed", compatible, text_of(point.line)},
      {"pulse-changed", meaning, is_pulsed(point) ? fmt::format("{}ms", point.pulse.count()) : ""},
      {"active-low-changed", meaning, point.line.active_low ? "true" : "false"},
      {"counter-changed", meaning, text_of(point.counter)},
      {"latched-changed", meaning, text_of(point.latched)},
      {"iio-changed", compatible, text_of(point.iio)},
      {"pwm-changed", compatible, text_of(point.pwm)},
      {"read-address-changed", compatible, point.read_address ? fmt::to_string(*point.read_address) : ""},
      {"values-changed", meaning, text_of(point.values)},
      {"invalid-changed", meaning, docs::words(point.invalid)},
      {"deadman-changed", compatible, deadman_text(point.host)},
  };
}

std::string described(const Tool& tool) { return given_fields(tool); }
std::string described(const Axis& axis) { return given_fields(axis); }

std::vector<Detail> details_of(const Map& map) {
  const Span<const std::string_view> allow = map.service.allow;
  return {
      {"name-changed", compatible, std::string(map.name)},
      {"unreadable-changed", compatible, areas_text(map.unreadable)},
      {"read-whole-changed", compatible, areas_text(map.read_whole)},
      {"allow-changed", compatible, fmt::format("{}", fmt::join(allow.begin(), allow.end(), ", "))},
      {"coupler-watchdog-changed", compatible, watchdog_text(map.coupler_watchdog)},
      {"sim-changed", compatible, sim_text(map)},
      {"security-changed", compatible, security_text(map)},
  };
}

}  // namespace coupler::tools
