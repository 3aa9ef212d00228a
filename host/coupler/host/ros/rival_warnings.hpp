// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <set>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "coupler/host/ros/log.hpp"

namespace coupler::host {

/// Another node that publishes `<name>/online`, as this one does: two drivers of one device, or of one name.
struct Rival {
  std::string topic;
  std::string node;
};

/// Warns of each once, as long as it is there.
class RivalWarnings {
 public:
  /// At each look.
  void warn_of(const std::vector<Rival>& rivals, Log& log) {
    std::set<std::string> now;
    for (const auto& [topic, node] : rivals)
      if (now.insert(topic + node).second && warned_of_.count(topic + node) == 0)
        log.log(
            Level::warning,
            fmt::format(
                "{} publishes {}, too: two drivers of one device, whose writes mix, or two devices of one "
                "name. End one of them, or give its device another name by --name",
                node, topic));
    warned_of_ = std::move(now);
  }

 private:
  std::set<std::string> warned_of_;
};

}  // namespace coupler::host
