// SPDX-License-Identifier: Apache-2.0
#include "coupler/tools/probe_scan.hpp"

#include <cstddef>
#include <utility>

#include <fmt/format.h>

#include "coupler/host/core/clock.hpp"
#include "coupler/map/fields.hpp"
#include "coupler/tools/interruption.hpp"
#include "coupler/tools/modbus_client.hpp"
#include "coupler/tools/progress_bar.hpp"

namespace coupler::tools {
namespace {

scan::Findings look(ProbeCall& call, ProgressBar& progress) {
  ModbusClient client(call.connection);
  host::SteadyClock clock;
  const Interruption interruption([&] {
    progress.end();
    clock.stop();
    client.interrupt();
  });
  scan::Findings findings = scan::scan(call.task, client, clock, progress);
  call.ended_by = interruption.signal();
  return findings;
}

}  // namespace

scan::Findings look_at_each_line(ProbeCall& call) {
  ProgressBar progress;
  scan::Findings findings;
  bool is_asked = false;
  for (std::size_t i = 0; i < call.lines.size(); ++i) {
    const Serial& line = call.lines[i];
    call.connection.serial = line;
    if (line.present())
      progress.where(
          fmt::format("at {}{}", rate_and_parity(line),
                      call.lines.size() > 1 ? fmt::format(" ({} of {})", i + 1, call.lines.size()) : ""));
    scan::Findings found = look(call, progress);
    const bool is_refused = found.broke_off && found.requests == 0;  // perhaps not the next one
    if (!is_refused || !is_asked) findings = std::move(found);
    is_asked |= !is_refused;
    if (findings.unit || (findings.broke_off && !is_refused) || progress.wants_end()) break;
  }
  return findings;
}

Failure why_unreachable(const host::Error& error, const Connection& connection) {
  return {failed, host::to_string(error),
          reach_remedy(connection, error,
                       "check that the device is on, that the port is right, and that no other client holds "
                       "its last connection")};
}

Failure why_no_unit(const ProbeCall& call) {
  const std::size_t units = call.task.units.size();
  if (!call.connection.is_rtu())
    return {failed, fmt::format("a server accepts connections, but none of {} units answers", units),
            "give its unit id, as HOST/17, or try all with --units 0-247,255"};
  return {
      failed, fmt::format("none of {} units answers on this line", units),
      call.connection.serial.present()
          ? "check A and B, the power, and the module's rate and parity: --baud and --parity say what is "
            "tried"
          : "check A and B, the power, and the gateway's rate and parity; if it translates, give its address "
            "without rtu+"};
}

}  // namespace coupler::tools
