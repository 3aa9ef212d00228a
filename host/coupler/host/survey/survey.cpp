// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/survey/survey.hpp"

#include "coupler/host/survey/identification.hpp"

namespace coupler::survey {
namespace {

void look_into_unit(const Task& task, Inquiry& inquiry, Watcher& watcher, Findings& findings) {
  inquiry.select(*findings.unit);
  watcher.begins("identification");
  findings.identification = read_identification(inquiry);
  findings.node = read_node_identity(inquiry);
  for (const Table table : tables) {
    findings.tables.emplace_back(table, task.window);
    TableSurvey survey(inquiry, watcher, findings.largest, task.stride, findings.tables.back());
    if (!survey.run()) return;
  }
  findings.is_complete = true;
}

}  // namespace

Findings survey(const Task& task, Master& master, host::Clock& clock, Watcher& watcher) {
  Findings findings;
  Inquiry inquiry(master, clock, watcher, task.rate);
  if (auto connected = inquiry.connect(); !connected) {
    if (!watcher.wants_end()) findings.broke_off = connected.error();
    return findings;
  }
  findings.units = find_units(inquiry, watcher, task.units);
  if (findings.units.empty())
    findings.is_complete = !inquiry.broke_off() && !watcher.wants_end();
  else {
    findings.unit = findings.units.front();
    look_into_unit(task, inquiry, watcher, findings);
  }
  findings.requests = inquiry.requests();
  findings.failures = inquiry.failures();
  findings.broke_off = inquiry.broke_off();
  master.close();
  return findings;
}

}  // namespace coupler::survey
