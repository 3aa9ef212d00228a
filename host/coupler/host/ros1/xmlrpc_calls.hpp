// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <XmlRpcValue.h>
#include <ros/this_node.h>

namespace coupler::host {

/// Returns the arguments of a call to the master or to a node: this node's name, then `texts`.
template <class... Texts>
XmlRpc::XmlRpcValue call_arguments(const Texts&... texts) {
  XmlRpc::XmlRpcValue arguments;
  arguments[0] = ros::this_node::getName();
  int i = 1;
  ((arguments[i++] = std::string(texts)), ...);
  return arguments;
}

/// Returns what the master answers; nothing if it reports an error, or is not there and is not waited for.
std::optional<XmlRpc::XmlRpcValue> ask_master(const std::string& method, const XmlRpc::XmlRpcValue& arguments,
                                              bool wait = false);

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
