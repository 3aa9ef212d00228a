// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "coupler/host/survey/draft.hpp"

namespace coupler::cli {

/// What a survey found, for people. `task` says what it looked for.
std::string probe_report(const survey::Findings& findings, const survey::Task& task,
                         const Connection& connection, const std::vector<survey::Match>& matches);

}  // namespace coupler::cli
