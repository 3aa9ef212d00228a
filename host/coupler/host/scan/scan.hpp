// SPDX-License-Identifier: Apache-2.0
// Finds out what a foreign device answers to.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "coupler/host/scan/recognition.hpp"
#include "coupler/host/scan/table_scan.hpp"
#include "coupler/map/identity.hpp"

namespace coupler::scan {

/// The task of a scan.
struct Task {
  std::vector<std::uint8_t> units{1, 255, 0};          ///< in this order; the first that answers is scanned
  modbus::Range window = modbus::Range::of(0, 10000);  ///< of each table
  std::uint32_t stride = 16;  ///< where blocks are refused, one address in so many is tried; 1: all
  double rate = 20;           ///< requests a second
  /// When a scan is over: when all tables are done, or before them at a node of this project, or also at a
  /// coupler that says what it has.
  enum class Ends { after_tables, at_node, when_known } ends = Ends::after_tables;
};

struct Findings {
  std::vector<std::uint8_t> units;                     ///< that are there
  std::optional<std::uint8_t> unit;                    ///< the rest is about it
  std::map<std::uint8_t, std::string> identification;  ///< FC 43/14
  std::optional<identity::Head> node;                  ///< a node of this project
  std::optional<Recognition> recognition;              ///< a coupler that says what it has
  std::vector<TableFindings> tables;                   ///< those that were looked at
  LargestReads largest;
  std::uint64_t requests = 0;
  std::vector<std::string> failures;     ///< requests without an answer, by kind
  std::optional<host::Error> broke_off;  ///< the device cannot be reached, or not any more
  bool is_complete = false;              ///< false: it was ended early
};

/// Connects, and reads until all is known or `progress` wants the end. It never writes.
Findings scan(const Task& task, Client& client, host::Clock& clock, ScanProgress& progress);

}  // namespace coupler::scan
