// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/ros1/xmlrpc_calls.hpp"

#include <XmlRpcClient.h>
#include <XmlRpcDispatch.h>
#include <ros/init.h>
#include <ros/master.h>
#include <ros/network.h>

#include <cstdint>
#include <memory>

#include "coupler/host/ros/shutdown.hpp"

namespace coupler::host {
namespace {

using XmlRpc::XmlRpcDispatch;
using XmlRpc::XmlRpcValue;

constexpr int most_waits = 20;
constexpr double longest_wait = 0.05;  ///< s

}  // namespace

std::optional<XmlRpcValue> ask_master(const std::string& method, const XmlRpcValue& arguments, bool wait) {
  XmlRpcValue response;
  XmlRpcValue answer;
  if (ros::isShuttingDown() || !ros::master::execute(method, arguments, response, answer, wait))
    return std::nullopt;
  return answer;
}

std::string uri_of(const std::string& node, bool wait_for_master) {
  auto uri = ask_master("lookupNode", call_arguments(node), wait_for_master);
  return uri && uri->getType() == XmlRpcValue::TypeString ? static_cast<std::string&>(*uri) : std::string();
}

void make(std::vector<NodeCall>& calls) {
  std::vector<std::unique_ptr<XmlRpc::XmlRpcClient>> clients;  // outlive the dispatch, which refers to them
  XmlRpcDispatch dispatch;
  const XmlRpcValue arguments = call_arguments();
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
  for (int i = 0; i < most_waits && !Shutdown::requested && !ros::isShuttingDown(); ++i)
    dispatch.work(longest_wait);
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
