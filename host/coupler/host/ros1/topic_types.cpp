// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/ros1/topic_types.hpp"

#include <XmlRpcClient.h>
#include <XmlRpcDispatch.h>
#include <XmlRpcException.h>
#include <ros/init.h>
#include <ros/network.h>

#include <cstdint>
#include <memory>
#include <utility>

#include "coupler/host/ros/program.hpp"
#include "coupler/host/ros1/node_uri.hpp"

namespace coupler::host {
namespace {

using XmlRpc::XmlRpcDispatch;
using XmlRpc::XmlRpcValue;

/// A node may hang, so there are this many waits for all answers together, of this many seconds each. The end
/// of the driver is delayed by one of them at most.
constexpr int most_waits = 20;
constexpr double wait = 0.05;

using Types = std::unordered_map<std::string, std::string>;

/// A call that is under way.
struct Call {
  std::unique_ptr<XmlRpc::XmlRpcClient> client;
  Types* types;
};

/// Reads [code, text, [[topic, type], …]]. Anything else is left out: a node of another make may answer it.
void read(XmlRpcValue& answer, Types& types) {
  try {
    XmlRpcValue& list = answer[2];
    for (int i = 0; i < list.size(); ++i)
      types[static_cast<std::string&>(list[i][0])] = static_cast<std::string&>(list[i][1]);
  } catch (const XmlRpc::XmlRpcException&) {
    return;  // what was read before it stays
  }
}

}  // namespace

void TopicTypes::fill(std::vector<Endpoint>& others, const TopicCheck& topics) {
  std::vector<Endpoint*> ends;
  for (Endpoint& other : others)
    if (!topics.needed_type(other.topic, other.publishes).empty()) ends.push_back(&other);
  find_wanted(ends);
  ask();
  for (Endpoint* const end : ends) {
    const Types& types = nodes_[end->node].types[end->publishes ? 1 : 0];
    if (const auto found = types.find(end->topic); found != types.end()) end->type = found->second;
  }
}

/// Forgets what is there no more, and whom to ask about it.
void TopicTypes::find_wanted(const std::vector<Endpoint*>& ends) {
  std::map<std::string, Known> now;
  for (const Endpoint* const end : ends) {
    const auto [place, is_new] = now.try_emplace(end->node);
    Known& node = place->second;
    if (is_new) node.uri = uri_of(end->node);
    const int which = end->publishes ? 1 : 0;
    const auto before = nodes_.find(end->node);
    const Types* const known =
        before != nodes_.end() && before->second.uri == node.uri ? &before->second.types[which] : nullptr;
    const auto type = known == nullptr ? Types::const_iterator() : known->find(end->topic);
    if (known != nullptr && type != known->end())
      node.types[which].insert(*type);
    else
      node.is_wanted[which] = true;
  }
  nodes_ = std::move(now);
}

/// All at the same time.
void TopicTypes::ask() {
  std::vector<Call> calls;  // outlives the dispatch, which refers to its clients
  XmlRpcDispatch dispatch;
  const XmlRpcValue arguments = own_name();
  for (auto& [name, node] : nodes_) {
    std::string host;
    std::uint32_t port = 0;
    if (!ros::network::splitURI(node.uri, host, port)) continue;
    for (const int which : {0, 1}) {
      if (!node.is_wanted[which]) continue;
      auto client = std::make_unique<XmlRpc::XmlRpcClient>(host.c_str(), static_cast<int>(port), "/");
      if (!client->executeNonBlock(which == 1 ? "getPublications" : "getSubscriptions", arguments)) continue;
      dispatch.addSource(client.get(), XmlRpcDispatch::WritableEvent | XmlRpcDispatch::Exception);
      calls.push_back({std::move(client), &node.types[which]});
    }
  }
  if (calls.empty()) return;
  for (int i = 0; i < most_waits && !Shutdown::requested && !ros::isShuttingDown(); ++i) dispatch.work(wait);
  for (auto& [client, types] : calls) {
    XmlRpcValue answer;
    if (client->executeCheckDone(answer) && answer.getType() == XmlRpcValue::TypeArray && answer.size() == 3)
      read(answer, *types);
    dispatch.removeSource(client.get());
  }
}

}  // namespace coupler::host
