// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/ros1/node_calls.hpp"

#include <XmlRpcClient.h>
#include <XmlRpcDispatch.h>
#include <ros/init.h>
#include <ros/master.h>
#include <ros/network.h>
#include <ros/this_node.h>

#include <cstdint>
#include <memory>

#include "coupler/host/ros/program.hpp"

namespace coupler::host {
namespace {

using XmlRpc::XmlRpcDispatch;
using XmlRpc::XmlRpcValue;

constexpr int most_waits = 20;
constexpr double wait = 0.05;  ///< s

XmlRpcValue own_name() {
  XmlRpcValue arguments;
  arguments[0] = ros::this_node::getName();
  return arguments;
}

}  // namespace

std::string uri_of(const std::string& node, bool wait_for_master) {
  XmlRpcValue arguments = own_name();
  arguments[1] = node;
  XmlRpcValue response;
  XmlRpcValue uri;
  if (!ros::master::execute("lookupNode", arguments, response, uri, wait_for_master)) return {};
  return uri.getType() == XmlRpcValue::TypeString ? static_cast<std::string&>(uri) : std::string();
}

void make(std::vector<NodeCall>& calls) {
  std::vector<std::unique_ptr<XmlRpc::XmlRpcClient>> clients;  // outlive the dispatch, which refers to them
  XmlRpcDispatch dispatch;
  const XmlRpcValue arguments = own_name();
  for (const NodeCall& call : calls) {
    std::string host;
    std::uint32_t port = 0;
    auto& client = clients.emplace_back();
    if (!ros::network::splitURI(call.uri, host, port)) continue;
    auto made = std::make_unique<XmlRpc::XmlRpcClient>(host.c_str(), static_cast<int>(port), "/");
    if (!made->executeNonBlock(call.method, arguments)) continue;
    client = std::move(made);
    dispatch.addSource(client.get(), XmlRpcDispatch::WritableEvent | XmlRpcDispatch::Exception);
  }
  // work() returns at once when all have answered.
  for (int i = 0; i < most_waits && !Shutdown::requested && !ros::isShuttingDown(); ++i) dispatch.work(wait);
  for (std::size_t i = 0; i < calls.size(); ++i) {
    if (!clients[i]) continue;
    XmlRpcValue answer;
    if (clients[i]->executeCheckDone(answer) && answer.getType() == XmlRpcValue::TypeArray &&
        answer.size() == 3)
      calls[i].answer = answer[2];
    dispatch.removeSource(clients[i].get());
  }
}

}  // namespace coupler::host
