// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <string>
#include <unordered_map>
#include <vector>

#include "coupler/host/ros/topic_check.hpp"

namespace coupler::host {

/// The types that other nodes have at their ends of topics. The master keeps one for each topic only, so the
/// nodes are asked: each once for what it has, and again when it has something new or has started again.
class TopicTypes {
 public:
  /// Fills in the types where `topics` needs one. A node that does not answer within a second has none, and
  /// is asked again at the next call.
  void fill(std::vector<Endpoint>& others, const TopicCheck& topics);

 private:
  /// Of one node.
  struct Known {
    std::string uri;
    std::unordered_map<std::string, std::string> types[2];  ///< by topic: subscribed, published
    bool is_wanted[2] = {false, false};                     ///< to be asked for
  };

  void find_wanted(const std::vector<Endpoint*>& ends);
  void ask();

  std::map<std::string, Known> nodes_;
};

}  // namespace coupler::host
