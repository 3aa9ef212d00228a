// SPDX-License-Identifier: Apache-2.0
#include "host/ros/diagnostics.hpp"

#include <fmt/format.h>

namespace coupler::driver {
namespace {

using Wrapper = diagnostic_updater::DiagnosticStatusWrapper;

void summarize(Wrapper& status, const Health& health) {
  switch (health.level) {
    case Level::info: return status.summary(diagnostic_msgs::DiagnosticStatus::OK, health.text);
    case Level::warning: return status.summary(diagnostic_msgs::DiagnosticStatus::WARN, health.text);
    case Level::error: return status.summary(diagnostic_msgs::DiagnosticStatus::ERROR, health.text);
  }
}

/// The distribution, in ms.
void add(Wrapper& status, const std::string& name, const Histogram& histogram) {
  const auto ms = [](Duration d) { return std::chrono::duration<double, std::milli>(d).count(); };
  for (const auto& [label, share] : {std::pair{"p50", 0.5}, {"p95", 0.95}, {"p99", 0.99}})
    status.addf(fmt::format("{} {} ms", name, label), "%.3f", ms(histogram.quantile(share)));
  status.addf(name + " max ms", "%.3f", ms(histogram.max()));
}

}  // namespace

Diagnostics::Diagnostics(const Map& map, diagnostic_updater::Updater& updater)
    : map_(map),
      hardware_id_(fmt::format("{} {}:{} unit {}", map.name, map.connection.address, map.connection.port,
                               map.connection.unit)) {
  const auto add = [&](const char* what, void (Diagnostics::*tell)(Wrapper&)) {
    updater.add(fmt::format("{} {}", map.name, what), [this, tell](Wrapper& status) {
      status.hardware_id = hardware_id_;
      (this->*tell)(status);
    });
  };
  add("connection", &Diagnostics::connection);
  add("polling", &Diagnostics::polling);
  add("writes", &Diagnostics::writes);
  if (map.coupler_watchdog.present()) add("watchdog", &Diagnostics::watchdog);
}

bool Diagnostics::update(const DeviceSnapshot& device, const std::vector<PointQuality>& points) {
  next_ = device;
  points_ = points;
  return next_.online != now_.online;
}

/// The first of a message.
void Diagnostics::connection(Wrapper& status) {
  before_ = std::exchange(now_, next_);
  summarize(status, connection_health(now_));
  status.add("online", now_.online);
  status.add("identity", std::string(to_string(now_.identity)));
  if (const auto hostname = hostname_of(now_.machine); !hostname.empty())
    status.add("hostname", std::string(hostname));
  if (now_.machine.serial != 0) status.add("serial", fmt::format("{:016x}", now_.machine.serial));
  status.add("connections", now_.connections);
  status.add("requests", now_.requests);
  status.add("timeouts", now_.timeouts);
  status.add("other failures", now_.failures);
}

void Diagnostics::polling(Wrapper& status) {
  summarize(status, polling_health(map_, points_, before_, now_));
  add(status, "cycle", now_.cycles);
  add(status, "request latency", now_.latency);
  status.add("overruns", now_.overruns);
  status.add("rejected ranges", now_.rejected_ranges);
  for (std::size_t code = 0; code < now_.exceptions.size(); ++code)
    if (now_.exceptions[code] > 0)
      status.add(to_string(Error(ExceptionReply{static_cast<modbus::Exception>(code)})),
                 now_.exceptions[code]);
}

void Diagnostics::writes(Wrapper& status) {
  summarize(status, writes_health(before_, now_));
  for (std::size_t i = 0; i < now_.writes.size(); ++i)
    status.add(std::string(to_string(static_cast<WriteResult::Outcome>(i))), now_.writes[i]);
}

void Diagnostics::watchdog(Wrapper& status) {
  summarize(status, watchdog_health(now_));
  status.add("timeout ms", map_.coupler_watchdog.timeout.count());
  status.add("fed", now_.watchdog.state == WatchdogStatus::State::fed);
  status.add("times expired", now_.watchdog.expiries);
}

}  // namespace coupler::driver
