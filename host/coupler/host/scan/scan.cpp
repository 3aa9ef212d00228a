// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/scan/scan.hpp"

#include "coupler/host/scan/identification.hpp"

namespace coupler::scan {
namespace {

/// Returns whether the unit is there; nullopt if the scan has to end.
std::optional<bool> ask_unit(Prober& prober, bool is_only_one) {
  for (const Table table :
       {Table::holding_registers, Table::input_registers, Table::coils, Table::discrete_inputs}) {
    std::uint16_t value = 0;
    const Reply reply = prober.try_read(table, modbus::Range::of(0, 1), &value);
    if (reply.kind == Reply::Kind::over) return std::nullopt;
    if (reply.is_given()) return true;
    if (reply.exception) return !host::is_unit_away(host::ExceptionReply{*reply.exception});
    if (reply.timed_out && !is_only_one) return false;
  }
  return false;
}

/// Those of `units` that are there. Each is asked for its first holding register. An exception is an answer,
/// too, unless a gateway gives it for a unit that is away (0A, 0B). A unit that stays silent costs one
/// timeout. Some devices close the connection, or stay silent, in place of refusing an address: then the
/// first address of the other tables is tried, after a silence only if no other unit is to be asked.
std::vector<std::uint8_t> find_units(Prober& prober, ScanProgress& progress,
                                     const std::vector<std::uint8_t>& units) {
  progress.begins("unit ids");
  std::vector<std::uint8_t> found;
  std::uint32_t asked = 0;
  for (const std::uint8_t unit : units) {
    prober.select(unit);
    const auto is_there = ask_unit(prober, units.size() == 1);
    if (!is_there) break;
    if (*is_there) found.push_back(unit);
    progress.moved(++asked, static_cast<std::uint32_t>(units.size()), prober.requests());
  }
  return found;
}

void look_into_unit(const Task& task, Prober& prober, ScanProgress& progress, Findings& findings) {
  prober.select(*findings.unit);
  progress.begins("identification");
  findings.identification = read_identification(prober);
  findings.node = read_node_identity(prober);
  if (!findings.node) findings.recognition = recognise(prober);
  if ((findings.node && task.ends != Task::Ends::after_tables) ||
      (findings.recognition && task.ends == Task::Ends::when_known)) {
    findings.is_complete = true;
    return;
  }
  for (const Table table : tables) {
    findings.tables.emplace_back(table, task.window);
    TableScan scan(prober, progress, findings.largest, task.stride, findings.tables.back());
    if (!scan.run()) return;
  }
  findings.is_complete = true;
}

}  // namespace

Findings scan(const Task& task, Client& client, host::Clock& clock, ScanProgress& progress) {
  Findings findings;
  Prober prober(client, clock, progress, task.rate);
  if (auto connected = prober.connect(); !connected) {
    if (!progress.wants_end()) findings.broke_off = connected.error();
    return findings;
  }
  findings.units = find_units(prober, progress, task.units);
  if (findings.units.empty())
    findings.is_complete = !prober.broke_off() && !progress.wants_end();
  else {
    findings.unit = findings.units.front();
    look_into_unit(task, prober, progress, findings);
  }
  findings.requests = prober.requests();
  findings.failures = prober.failures();
  findings.broke_off = prober.broke_off();
  client.close();
  return findings;
}

}  // namespace coupler::scan
