// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/ros/diagnostics.hpp"

#include <utility>

#include <fmt/format.h>

namespace coupler::host {
namespace {

/// The figures of an entry.
class Figures {
 public:
  explicit Figures(Diagnosis& diagnosis) : figures_(diagnosis.figures) {}

  void add(std::string name, std::string value) { figures_.emplace_back(std::move(name), std::move(value)); }
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
  std::vector<std::pair<std::string, std::string>>& figures_;
};

Diagnosis diagnosis_of(Health health) { return {health.level, std::move(health.text), {}, {}}; }

}  // namespace

Diagnostics::Diagnostics(const Map& map, Node& node)
    : map_(map),
      hardware_id_(fmt::format("{} {}:{} unit {}", map.name, map.connection.address, map.connection.port,
                               map.connection.unit)) {
  const auto add = [&](const char* what, Diagnosis (Diagnostics::*tell)()) {
    node.add_diagnosis(fmt::format("{} {}", map.name, what), [this, tell] {
      Diagnosis diagnosis = (this->*tell)();
      diagnosis.hardware_id = hardware_id_;
      return diagnosis;
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
Diagnosis Diagnostics::connection() {
  before_ = std::exchange(now_, next_);
  Diagnosis result = diagnosis_of(connection_health(now_));
  Figures figures(result);
  figures.add("online", now_.online);
  figures.add("identity", std::string(to_string(now_.identity)));
  if (const auto hostname = hostname_of(now_.machine); !hostname.empty())
    figures.add("hostname", std::string(hostname));
  if (now_.machine.serial != 0) figures.add("serial", fmt::format("{:016x}", now_.machine.serial));
  figures.add("connections", now_.connections);
  figures.add("requests", now_.requests);
  figures.add("timeouts", now_.timeouts);
  figures.add("other failures", now_.failures);
  return result;
}

Diagnosis Diagnostics::polling() {
  Diagnosis result = diagnosis_of(polling_health(map_, points_, before_, now_));
  Figures figures(result);
  figures.add("cycle", now_.cycles);
  figures.add("request latency", now_.latency);
  figures.add("overruns", now_.overruns);
  figures.add("rejected ranges", now_.rejected_ranges);
  for (std::size_t code = 0; code < now_.exceptions.size(); ++code)
    if (now_.exceptions[code] > 0)
      figures.add(to_string(Error(ExceptionReply{static_cast<modbus::Exception>(code)})),
                  now_.exceptions[code]);
  return result;
}

Diagnosis Diagnostics::writes() {
  Diagnosis result = diagnosis_of(writes_health(before_, now_));
  Figures figures(result);
  for (std::size_t i = 0; i < now_.writes.size(); ++i)
    figures.add(std::string(to_string(static_cast<WriteResult::Outcome>(i))), now_.writes[i]);
  return result;
}

Diagnosis Diagnostics::watchdog() {
  Diagnosis result = diagnosis_of(watchdog_health(now_));
  Figures figures(result);
  figures.add("timeout ms", static_cast<std::uint64_t>(map_.coupler_watchdog.timeout.count()));
  figures.add("fed", now_.watchdog.state == WatchdogStatus::State::fed);
  figures.add("times expired", now_.watchdog.expiries);
  return result;
}

}  // namespace coupler::host
