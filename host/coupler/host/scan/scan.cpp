// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/scan/scan.hpp"

#include "coupler/host/scan/identification.hpp"

namespace coupler::scan {
namespace {

void look_into_unit(const Task& task, Prober& prober, ScanProgress& progress, Findings& findings) {
  prober.select(*findings.unit);
  progress.begins("identification");
  findings.identification = read_identification(prober);
  findings.node = read_node_identity(prober);
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
