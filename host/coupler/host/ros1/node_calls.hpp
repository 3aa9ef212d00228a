// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <XmlRpcValue.h>

namespace coupler::host {

/// Returns the URI of a node; empty if the master does not know it, or does not answer, unless it is waited
/// for.
std::string uri_of(const std::string& node, bool wait_for_master = false);

/// A call of the API that each node has (http://wiki.ros.org/ROS/Slave_API), with its name as the argument.
struct NodeCall {
  std::string uri;
  const char* method;
  XmlRpc::XmlRpcValue answer{};  ///< not valid if there was none
};

/// Makes all calls at the same time. A node may hang, so answers are waited for a second at most, and only
/// 50 ms more when the driver is to end. A host name that cannot be resolved takes as long as the system's
/// resolver does.
void make(std::vector<NodeCall>& calls);

}  // namespace coupler::host
