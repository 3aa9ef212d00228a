// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "coupler/host/scan/draft.hpp"

namespace coupler::tools {

/// No address that was tried can be read: there is nothing to draft.
bool shows_nothing(const scan::Findings& findings);

/// Returns a text for people about what a scan found, of a node that was not scanned only what it is. `task`
/// says what it looked for.
std::string probe_report(const scan::Findings& findings, const scan::Task& task, const Connection& connection,
                         const std::vector<scan::Match>& matches);

}  // namespace coupler::tools
