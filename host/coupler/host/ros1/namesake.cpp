// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/ros1/namesake.hpp"

#include <XmlRpcException.h>
#include <XmlRpcSocket.h>
#include <ros/console.h>
#include <ros/init.h>
#include <ros/this_node.h>
#include <ros/xmlrpc_manager.h>

#include <cstdlib>
#include <set>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include "coupler/host/ros1/xmlrpc_calls.hpp"
#include "coupler/map/printable.hpp"

namespace coupler::host {
namespace {

using XmlRpc::XmlRpcValue;

/// roscpp reads this variable in ros::start() only.
void use_address_family() {
  const char* const family = std::getenv("ROS_IPV6");
  XmlRpc::XmlRpcSocket::s_use_ipv6_ = family != nullptr && std::string_view(family) == "on";
}

/// Returns the topics that the master knows to be published by the node of this name and by no other one.
std::set<std::string> topics_of_its_own() {
  std::set<std::string> topics;
  auto state = ask_master("getSystemState", call_arguments());
  if (!state) return topics;
  XmlRpcValue& published = (*state)[0];  // [[topic, [node, …]], …]
  for (int i = 0; i < published.size(); ++i) {
    XmlRpcValue& nodes = published[i][1];
    if (nodes.size() == 1 && static_cast<std::string&>(nodes[0]) == ros::this_node::getName())
      topics.insert(static_cast<std::string&>(published[i][0]));
  }
  return topics;
}

/// Returns the process of the node of this name, if it is alive. One that was killed stays registered, and
/// another node, even of another master, may have its port by now: that one has other topics.
std::optional<int> process_of_namesake(const std::string& uri) {
  std::vector<NodeCall> calls = {{uri, "getPid"}, {uri, "getPublications"}};
  make(calls);
  XmlRpcValue& process = calls[0].answer;
  XmlRpcValue& published = calls[1].answer;
  if (!process.valid() || !published.valid()) return std::nullopt;
  const std::set<std::string> expected = topics_of_its_own();
  bool is_it = expected.empty();
  for (int i = 0; i < published.size(); ++i)
    is_it = is_it || expected.count(static_cast<std::string&>(published[i][0])) > 0;
  if (!is_it) return std::nullopt;
  return static_cast<int&>(process);
}

std::string end_text(const std::string& reason) {
  if (reason.find("same name") == std::string::npos)
    return fmt::format("told to end: {}", printable_lines(reason));
  return fmt::format(
      "another node has started with the name {}, and so the ROS master ends this one: start it once, or "
      "give each driver a name of its own (--name)",
      ros::this_node::getName());
}

/// Ends the node as roscpp does, and says why.
void shut_down(XmlRpcValue& arguments, XmlRpcValue& result) {
  if (arguments.getType() == XmlRpcValue::TypeArray && arguments.size() > 1) {
    ROS_WARN("%s", end_text(static_cast<std::string&>(arguments[1])).c_str());
    ros::requestShutdown();
  }
  result = ros::xmlrpc::responseInt(1, "", 0);
}

}  // namespace

std::optional<std::string> namesake_error() {
  const std::string& name = ros::this_node::getName();
  use_address_family();
  try {
    const std::string uri = uri_of(name, true);
    if (uri.empty()) return std::nullopt;
    const auto process = process_of_namesake(uri);
    if (!process) return std::nullopt;
    return fmt::format(
        "a node {} runs already (process {}, {}), and two of one name would end each other: nothing is "
        "started. Stop that one, or give this one another name: --name NAME, with device.launch name:=NAME",
        name, *process, uri);
  } catch (const XmlRpc::XmlRpcException&) {
    return std::nullopt;  // a node or a master of another make: as if it had not been asked
  }
}

void tell_why_ros_ends() { ros::XMLRPCManager::instance()->bind("shutdown", shut_down); }

}  // namespace coupler::host
