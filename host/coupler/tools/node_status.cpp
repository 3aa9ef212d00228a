// SPDX-License-Identifier: Apache-2.0
#include "coupler/tools/node_status.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "coupler/base/utc_text.hpp"
#include "coupler/host/core/node_map.hpp"
#include "coupler/host/scan/identification.hpp"
#include "coupler/json/json_text.hpp"
#include "coupler/map/fingerprint.hpp"
#include "coupler/map/node_address.hpp"
#include "coupler/map/printable.hpp"
#include "coupler/tools/snapshot.hpp"

namespace coupler::tools {
namespace {

using host::Error;
using host::Result;

bool is_answer(const Error& error) { return exception_in(error) != nullptr && !is_unit_away(error); }

/// Returns whether the device has answered. An error ends the questions.
Result<bool> read_area(host::Link& link, NodeStatus& status) {
  const auto report = host::read_report(link);
  if (!report) {
    if (is_unit_away(report.error())) return tl::make_unexpected(report.error());
    status.error = report.error();
    link.close();  // a late answer must not be taken for another
    if (auto connected = link.connect(); !connected) return tl::make_unexpected(connected.error());
    return false;
  }
  status.report = *report;
  if (!status.report) return true;
  const auto further = host::read_further(link);
  if (!further) return tl::make_unexpected(further.error());
  status.further = *further;
  return true;
}

Result<> read_all(host::Link& link, const Identify& identify, NodeStatus& status) {
  if (auto connected = link.connect(); !connected) return connected;
  status.certificates = link.certificates();
  const auto answered = read_area(link, status);
  if (!answered) return tl::make_unexpected(answered.error());
  std::optional<Error> failure;
  const auto ask = [&](modbus::ReadDeviceIdentification wanted) -> std::optional<scan::IdentificationPage> {
    auto page = identify(wanted);
    if (page || is_answer(page.error())) status.error.reset();  // it is there, and foreign
    if (page) return *std::move(page);
    if (!is_answer(page.error())) failure = page.error();
    return std::nullopt;
  };
  status.identification = scan::read_identification(ask);
  // A foreign coupler may ignore this question as well.
  if (failure && (status.report || is_unit_away(*failure))) return tl::make_unexpected(*failure);
  return {};
}

using identity::Report;
using nlohmann::ordered_json;

// The objects that a node has in FC 43/14.
constexpr std::uint8_t product_code = 1;  ///< the map's name
constexpr std::uint8_t revision = 2;      ///< the version of OpenCoupler

std::string object(const NodeStatus& status, std::uint8_t id) {
  const auto found = status.identification.find(id);
  return found == status.identification.end() ? std::string() : found->second;
}

std::string or_unknown(const std::string& text) { return text.empty() ? "unknown" : printable(text); }

std::string serial_text(const identity::Machine& machine) {
  return machine.serial == 0 ? std::string() : fmt::format("{:016x}", machine.serial);
}

/// A state that a newer node has is shown as its number.
std::string state_text(const Report& report) {
  const std::size_t state = report.watchdog_state;
  return state < identity::watchdog_states.size() ? std::string(identity::watchdog_states[state])
                                                  : fmt::to_string(state);
}

std::string watchdog_text(const Report& report) {
  std::string text = state_text(report);
  if (report.watchdog_left != 0)
    text += fmt::format(", {}{} ms left", report.watchdog_left == 0xFFFF ? "at least " : "",
                        report.watchdog_left);
  return text;
}

/// Returns the functions that only our nodes have, each with its purpose.
std::string functions_text(const identity::Functions& functions) {
  std::string text;
  if (functions.tells_changes) text += "65 (waiting for changes)";
  if (functions.schedules_outputs) text += fmt::format("{}66 (outputs at a time)", text.empty() ? "" : ", ");
  return text.empty() ? "none" : text;
}

ordered_json or_null(const std::string& text) { return text.empty() ? ordered_json() : ordered_json(text); }

std::string certificate_text(const host::Certificate& shown) {
  return fmt::format("'{}', until {}", printable(shown.name), minute_text(shown.validity.end));
}

std::string role_text(const host::Certificate& own) {
  return own.role.empty() ? "without a role" : "role " + printable(own.role);
}

ordered_json certificate_json(const host::Certificate& shown) {
  return {{"name", shown.name}, {"role", or_null(shown.role)}, {"ends", utc_text(shown.validity.end)}};
}

/// An older node does not say how long it is.
std::string timeout_text(const NodeStatus& status) {
  if (status.report->watchdog_state == 0) return "none";
  const std::uint32_t timeout = status.further.watchdog_timeout;
  return timeout == 0 ? "unknown" : fmt::format("{} ms", timeout);
}

/// "93784 s (1 d 2 h 3 min)"
std::string uptime_text(std::uint32_t seconds) {
  std::string text = fmt::format("{} s", seconds);
  if (seconds < 60) return text;
  const auto minutes = seconds / 60;
  text += " (";
  if (minutes >= 24 * 60) text += fmt::format("{} d ", minutes / (24 * 60));
  if (minutes >= 60) text += fmt::format("{} h ", minutes / 60 % 24);
  return text + fmt::format("{} min)", minutes % 60);
}

std::string row(std::string_view what, const std::string& value) {
  return fmt::format("  {:<36}  {}\n", what, value);
}

ordered_json functions_json(const identity::Functions& functions) {
  ordered_json json = ordered_json::array();
  if (functions.tells_changes) json.push_back(modbus::Function::wait_for_changes);
  if (functions.schedules_outputs) json.push_back(modbus::Function::schedule_output);
  return json;
}

ordered_json statistics_json(const Report& report) {
  ordered_json json = ordered_json::object();
  for (const identity::Counter& counter : identity::counters)
    json[std::string(counter.key)] = report.counts.*counter.count;
  return json;
}

ordered_json identification_json(const NodeStatus& status) {
  ordered_json json = ordered_json::object();
  for (const auto& [id, value] : status.identification) json[scan::object_name(id)] = value;
  return json;
}

}  // namespace

NodeStatus read_status(host::Link& link, const Identify& identify) {
  NodeStatus status;
  if (const auto done = read_all(link, identify, status); !done) status.error = done.error();
  link.close();
  status.at = std::chrono::system_clock::now();
  return status;
}

std::string status_text(const NodeStatus& status, const Connection& where) {
  const std::string device = printable(node_address_text(where));
  if (!status.report) {
    std::string text;
    for (const auto& [id, value] : status.identification)
      text += row(scan::object_name(id), printable(value));
    return text.empty() ? text : fmt::format("identification of {} (FC 43/14):\n{}", device, text);
  }
  const Report& report = *status.report;
  std::string text = fmt::format("the node at {}, {}:\n", device, utc_text(status.at));
  if (status.certificates) {
    text += row("certificate of this side",
                certificate_text(status.certificates->own) + ", " + role_text(status.certificates->own));
    text += row("certificate of the node", certificate_text(status.certificates->device));
  }
  text += row("map", or_unknown(object(status, product_code)));
  text += row("fingerprint", fingerprint_text(report.head.fingerprint));
  text += row("size and CRC-32 of the map",
              fmt::format("{} bytes, {:08x}", report.head.map_size, report.head.map_crc));
  text += row("version of OpenCoupler", or_unknown(object(status, revision)));
  text += row("hostname", or_unknown(std::string(hostname_of(status.further.machine))));
  text += row("serial", or_unknown(serial_text(status.further.machine)));
  text += row("watchdog", watchdog_text(report));
  text += row("timeout of the watchdog", timeout_text(status));
  text += row("function codes of its own", functions_text(status.further.functions));
  if (!report.has_statistics)
    return text + row("statistics", "not for clients that may not read every point");
  text += row("uptime", uptime_text(report.uptime));
  for (const identity::Counter& counter : identity::counters)
    text += row(counter.text, fmt::to_string(report.counts.*counter.count));
  return text;
}

std::string status_json(const NodeStatus& status, const Connection& where) {
  ordered_json json{{"device", node_address_text(where)},
                    {"time", utc_text(status.at)},
                    {"trouble", or_null(status.error ? to_string(*status.error) : std::string())},
                    {"node", status.report.has_value()},
                    {"name", nullptr},
                    {"version", nullptr},
                    {"fingerprint", nullptr},
                    {"map", nullptr},
                    {"hostname", nullptr},
                    {"serial", nullptr},
                    {"watchdog", nullptr},
                    {"functions", nullptr},
                    {"uptime_s", nullptr},
                    {"statistics", nullptr},
                    {"certificates", nullptr},
                    {"identification", identification_json(status)}};
  if (status.certificates)
    json["certificates"] = {{"own", certificate_json(status.certificates->own)},
                            {"device", certificate_json(status.certificates->device)}};
  if (status.report) {
    const Report& report = *status.report;
    json["name"] = or_null(object(status, product_code));
    json["version"] = or_null(object(status, revision));
    json["fingerprint"] = fingerprint_text(report.head.fingerprint);
    json["map"] = {{"bytes", report.head.map_size}, {"crc32", fmt::format("{:08x}", report.head.map_crc)}};
    json["hostname"] = or_null(std::string(hostname_of(status.further.machine)));
    json["serial"] = or_null(serial_text(status.further.machine));
    json["watchdog"] = {
        {"state", state_text(report)}, {"left_ms", report.watchdog_left}, {"timeout_ms", nullptr}};
    if (const auto timeout = status.further.watchdog_timeout; timeout != 0)
      json["watchdog"]["timeout_ms"] = timeout;
    json["functions"] = functions_json(status.further.functions);
    if (report.has_statistics) {
      json["uptime_s"] = report.uptime;
      json["statistics"] = statistics_json(report);
    }
  }
  return json_text(json);
}

}  // namespace coupler::tools
