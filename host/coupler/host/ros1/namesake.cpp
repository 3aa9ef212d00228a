// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/ros1/namesake.hpp"

#include <XmlRpcClient.h>
#include <XmlRpcDispatch.h>
#include <XmlRpcException.h>
#include <ros/console.h>
#include <ros/init.h>
#include <ros/master.h>
#include <ros/network.h>
#include <ros/this_node.h>
#include <ros/xmlrpc_manager.h>

#include <cstdint>
#include <set>

#include <fmt/format.h>

#include "coupler/host/ros1/node_uri.hpp"
#include "coupler/map/printable.hpp"

namespace coupler::host {
namespace {

using XmlRpc::XmlRpcDispatch;
using XmlRpc::XmlRpcValue;

/// A node that hangs is waited for this often and, in seconds, this long.
constexpr int most_looks = 20;
constexpr double look = 0.05;

/// Nothing if it does not answer.
std::optional<int> process_of(const std::string& uri) {
  std::string host;
  std::uint32_t port = 0;
  if (!ros::network::splitURI(uri, host, port)) return std::nullopt;
  XmlRpc::XmlRpcClient client(host.c_str(), static_cast<int>(port), "/");
  if (!client.executeNonBlock("getPid", own_name())) return std::nullopt;
  XmlRpcDispatch dispatch;
  dispatch.addSource(&client, XmlRpcDispatch::WritableEvent | XmlRpcDispatch::Exception);
  for (int i = 0; i < most_looks; ++i) dispatch.work(look);  // no more once there is an answer
  XmlRpcValue answer;
  const bool answered = client.executeCheckDone(answer);
  dispatch.removeSource(&client);
  if (!answered || answer.getType() != XmlRpcValue::TypeArray || answer.size() != 3) return std::nullopt;
  return static_cast<int&>(answer[2]);
}

/// A node that was killed stays registered, and another one may have its port by now.
bool is_of_another_name(const std::string& uri) {
  XmlRpcValue response;
  XmlRpcValue state;
  if (!ros::master::execute("getSystemState", own_name(), response, state, false)) return false;
  std::set<std::string> names;
  for (int kind = 0; kind < state.size(); ++kind)
    for (int i = 0; i < state[kind].size(); ++i)
      for (int n = 0; n < state[kind][i][1].size(); ++n)
        names.insert(static_cast<std::string&>(state[kind][i][1][n]));
  names.erase(ros::this_node::getName());
  for (const std::string& name : names)
    if (uri_of(name) == uri) return true;
  return false;
}

/// What roscpp does, but with the remedy.
void shut_down(XmlRpcValue& arguments, XmlRpcValue& result) {
  if (arguments.getType() == XmlRpcValue::TypeArray && arguments.size() > 1) {
    const auto& reason = static_cast<std::string&>(arguments[1]);
    if (reason.find("same name") != std::string::npos)
      ROS_ERROR("%s",
                fmt::format("another node has started with the name {}, and so the ROS master ends this one: "
                            "start it once, or give each driver a name of its own (--name)",
                            ros::this_node::getName())
                    .c_str());
    else
      ROS_WARN("%s", fmt::format("told to end: {}", printable_lines(reason)).c_str());
    ros::requestShutdown();
  }
  result = ros::xmlrpc::responseInt(1, "", 0);
}

}  // namespace

std::optional<std::string> namesake_error() {
  const std::string& name = ros::this_node::getName();
  try {
    const std::string uri = uri_of(name, true);
    if (uri.empty()) return std::nullopt;
    const auto process = process_of(uri);
    if (!process || is_of_another_name(uri)) return std::nullopt;
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
