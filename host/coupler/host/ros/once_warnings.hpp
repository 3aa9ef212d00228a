// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <string_view>
#include <unordered_set>
#include <utility>
#include <vector>

#include <fmt/format.h>

namespace coupler::host {

/// Something that is wrong in the ROS graph now.
struct Finding {
  std::string key;                    ///< what and where
  std::function<std::string()> text;  ///< empty: there is nothing to be said of it
  bool is_sure = true;                ///< the text is not empty
};

/// Warns of each finding once, as long as it is there.
class OnceWarnings {
 public:
  static constexpr std::size_t most_at_once = 20;

  /// Returns the lines that are to be logged. `findings`: all that there are now, what is sure first.
  /// `others`: what those are that are only counted.
  std::vector<std::string> update(const std::vector<Finding>& findings, std::string_view others) {
    std::vector<std::string> lines;
    std::unordered_set<std::string> now;
    std::size_t looked_at = 0;
    std::size_t unsaid = 0;
    for (const Finding& finding : findings) {
      if (warned_of_.count(finding.key) != 0) {
        now.insert(finding.key);
        continue;
      }
      if (looked_at == most_at_once && !finding.is_sure) continue;  // the next look is at it
      if (!now.insert(finding.key).second) continue;
      if (looked_at == most_at_once) {
        ++unsaid;
        continue;
      }
      ++looked_at;
      if (std::string text = finding.text(); !text.empty()) lines.push_back(std::move(text));
    }
    if (unsaid > 0) lines.push_back(fmt::format("and {} more {}", unsaid, others));
    warned_of_ = std::move(now);
    return lines;
  }

 private:
  std::unordered_set<std::string> warned_of_;
};

}  // namespace coupler::host
