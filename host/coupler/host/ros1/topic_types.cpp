// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/ros1/topic_types.hpp"

#include <XmlRpcException.h>

#include <utility>

#include "coupler/host/ros1/xmlrpc_calls.hpp"

namespace coupler::host {
namespace {

using XmlRpc::XmlRpcValue;
using Types = std::unordered_map<std::string, std::string>;

/// Reads [[topic, type], …]. Anything else is left out: a node of another make may answer it.
void read(XmlRpcValue& answer, Types& types) {
  try {
    for (int i = 0; i < answer.size(); ++i)
      types[static_cast<std::string&>(answer[i][0])] = static_cast<std::string&>(answer[i][1]);
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

void TopicTypes::ask() {
  std::vector<NodeCall> calls;
  std::vector<Types*> places;  // of the answers
  for (auto& [name, node] : nodes_) {
    for (const int which : {0, 1}) {
      if (!node.is_wanted[which]) continue;
      calls.push_back({node.uri, which == 1 ? "getPublications" : "getSubscriptions"});
      places.push_back(&node.types[which]);
    }
  }
  make(calls);
  for (std::size_t i = 0; i < calls.size(); ++i)
    if (calls[i].answer.valid()) read(calls[i].answer, *places[i]);
}

}  // namespace coupler::host
