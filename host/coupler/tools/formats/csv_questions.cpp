// SPDX-License-Identifier: Apache-2.0
#include "coupler/tools/formats/csv_questions.hpp"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

namespace coupler::formats {

void Questions::ask(Question question, const Cell& cell, std::string what, std::string remedy) {
  for (Asked& asked : asked_) {
    if (asked.question != question) continue;
    ++asked.more;
    return;
  }
  asked_.push_back({question, cell.at, std::move(what), std::move(remedy)});
}

bool Questions::is_asked(Question question) const {
  return std::any_of(asked_.begin(), asked_.end(),
                     [question](const Asked& asked) { return asked.question == question; });
}

void Questions::tell(loader::Problems& problems) const {
  for (const Asked& asked : asked_) {
    // What is answered to "x10" holds for "0.1V", but not the other way.
    if (asked.question == Question::units && is_asked(Question::units_times)) continue;
    const std::string more =
        asked.more > 0 ? fmt::format(" ({} more {} the same)", asked.more, asked.more == 1 ? "asks" : "ask")
                       : "";
    problems.error(asked.at, asked.what + more, asked.remedy);
  }
}

}  // namespace coupler::formats
