// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/ros/diagnostics.hpp"

#include <utility>

#include <fmt/format.h>

namespace coupler::host {
namespace {

/// Adds values to an entry.
class Values {
 public:
  explicit Values(DiagnosticEntry& entry) : values_(entry.values) {}

  void add(std::string name, std::string value) { values_.emplace_back(std::move(name), std::move(value)); }
  void add(std::string name, const char* value) { add(std::move(name), std::string(value)); }
  void add(std::string name, bool value) { add(std::move(name), value ? "True" : "False"); }
  void add(std::string name, std::uint64_t value) { add(std::move(name), fmt::to_string(value)); }
  /// A distribution, in ms.
  void add(const std::string& name, const Histogram& histogram) {
    const auto ms = [](Duration d) {
      return fmt::format("{:.3f}", std::chrono::duration<double, std::milli>(d).count());
    };
    for (const auto& [label, share] : {std::pair{"p50", 0.5}, {"p95", 0.95}, {"p99", 0.99}})
      add(fmt::format("{} {} ms", name, label), ms(histogram.quantile(share)));
    add(name + " max ms", ms(histogram.max()));
  }

 private:
  std::vector<std::pair<std::string, std::string>>& values_;
};

std::string hardware_id(const Connection& device) {
  if (device.serial.present()) return fmt::format("{} unit {}", device.serial.device, device.unit);
  return fmt::format("{}:{} unit {}", device.address, device.port, device.unit);
}

DiagnosticEntry entry_of(Health health) { return {health.level, std::move(health.text), {}, {}}; }

}  // namespace

MapDiagnostics::MapDiagnostics(const Connection& device, Node* node) : node_(node) {
  entry_->hardware_id = hardware_id(device);
  if (node_ != nullptr) node_->add_diagnostics("map", [entry = entry_] { return *entry; });
}

void MapDiagnostics::say(Level level, const std::string& text) {
  entry_->level = level;
  entry_->message = text;
}

void MapDiagnostics::publish_if_due() {
  const Time now = std::chrono::steady_clock::now();
  if (node_ == nullptr || now < due_) return;
  due_ = now + diagnostics_interval;
  node_->publish_diagnostics();
}

Diagnostics::Diagnostics(const Map& map, Node& node)
    : map_(map), hardware_id_(fmt::format("{} {}", map.name, hardware_id(map.connection))) {
  const auto add = [&](const char* what, DiagnosticEntry (Diagnostics::*make)()) {
    node.add_diagnostics(fmt::format("{} {}", map.name, what), [this, make] {
      DiagnosticEntry entry = (this->*make)();
      entry.hardware_id = hardware_id_;
      return entry;
    });
  };
  add("connection", &Diagnostics::connection);
  add("polling", &Diagnostics::polling);
  add("writes", &Diagnostics::writes);
  if (map.coupler_watchdog.present()) add("watchdog", &Diagnostics::watchdog);
  if (map.connection.tls.present()) add("certificates", &Diagnostics::certificates);
}

bool Diagnostics::update(const DeviceSnapshot& device, const std::vector<PointQuality>& points,
                         const std::string& slow) {
  slow_ = slow;
  next_ = device;
  points_ = points;
  return next_.online != now_.online;
}

/// The first entry of a message.
DiagnosticEntry Diagnostics::connection() {
  before_ = std::exchange(now_, next_);
  DiagnosticEntry result = entry_of(connection_health(now_));
  Values values(result);
  values.add("online", now_.online);
  values.add("identity", std::string(to_string(now_.identity)));
  if (const auto hostname = hostname_of(now_.machine); !hostname.empty())
    values.add("hostname", std::string(hostname));
  if (now_.machine.serial != 0) values.add("serial", fmt::format("{:016x}", now_.machine.serial));
  values.add("connections", now_.connections);
  values.add("requests", now_.requests);
  values.add("timeouts", now_.timeouts);
  values.add("other failures", now_.failures);
  if (map_.connection.is_rtu()) values.add("discarded bytes", now_.discarded);
  return result;
}

DiagnosticEntry Diagnostics::polling() {
  Health health = polling_health(map_, points_, before_, now_);
  if (health.level == Level::info && !slow_.empty()) health = {Level::warning, slow_};  // it does not flap
  DiagnosticEntry result = entry_of(health);
  Values values(result);
  values.add("cycle", now_.cycles);
  values.add("request latency", now_.latency);
  values.add("overruns", now_.overruns);
  values.add("rejected ranges", now_.rejected_ranges);
  values.add("changes", now_.changes);
  values.add("changes lost", now_.changes_lost);
  for (std::size_t code = 0; code < now_.exceptions.size(); ++code)
    if (now_.exceptions[code] > 0)
      values.add(to_string(Error(ExceptionReply{static_cast<modbus::Exception>(code)})),
                 now_.exceptions[code]);
  return result;
}

DiagnosticEntry Diagnostics::writes() {
  DiagnosticEntry result = entry_of(writes_health(before_, now_));
  Values values(result);
  for (std::size_t i = 0; i < now_.writes.size(); ++i)
    values.add(std::string(to_string(static_cast<WriteResult::Outcome>(i))), now_.writes[i]);
  return result;
}

DiagnosticEntry Diagnostics::watchdog() {
  DiagnosticEntry result = entry_of(watchdog_health(now_));
  Values values(result);
  values.add("timeout ms", static_cast<std::uint64_t>(map_.coupler_watchdog.timeout.count()));
  values.add("fed", now_.watchdog.state == WatchdogStatus::State::fed);
  values.add("times expired", now_.watchdog.expiries);
  return result;
}

DiagnosticEntry Diagnostics::certificates() {
  DiagnosticEntry result = entry_of(certificates_health(now_.certificates, std::chrono::system_clock::now()));
  if (!now_.certificates) return result;
  Values values(result);
  const auto& [own, device, has_pin] = *now_.certificates;
  values.add("this machine", own.name);
  values.add("role", own.role);
  values.add("ends", minute_text(own.validity.end));
  values.add("the device", device.name);
  values.add("the device's ends", minute_text(device.validity.end));
  values.add("the device has a pin", has_pin);
  return result;
}

}  // namespace coupler::host
