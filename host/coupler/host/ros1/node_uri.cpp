// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/ros1/node_uri.hpp"

#include <ros/master.h>
#include <ros/this_node.h>

namespace coupler::host {

XmlRpc::XmlRpcValue own_name() {
  XmlRpc::XmlRpcValue arguments;
  arguments[0] = ros::this_node::getName();
  return arguments;
}

std::string uri_of(const std::string& node, bool wait_for_master) {
  XmlRpc::XmlRpcValue arguments = own_name();
  arguments[1] = node;
  XmlRpc::XmlRpcValue response;
  XmlRpc::XmlRpcValue uri;
  if (!ros::master::execute("lookupNode", arguments, response, uri, wait_for_master)) return {};
  return uri.getType() == XmlRpc::XmlRpcValue::TypeString ? static_cast<std::string&>(uri) : std::string();
}

}  // namespace coupler::host
