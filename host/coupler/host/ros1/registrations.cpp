// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/ros1/registrations.hpp"

#include <XmlRpcClient.h>
#include <ros/connection_manager.h>
#include <ros/init.h>
#include <ros/master.h>
#include <ros/network.h>
#include <ros/param.h>
#include <ros/this_node.h>
#include <ros/xmlrpc_manager.h>

#include <algorithm>
#include <optional>

#include <fmt/format.h>

namespace coupler::host {
namespace {

using XmlRpc::XmlRpcValue;

/// The arguments of a call: this node's name, and these.
template <class... Texts>
XmlRpcValue call(const Texts&... texts) {
  XmlRpcValue arguments;
  arguments[0] = ros::this_node::getName();
  int i = 1;
  ((arguments[i++] = std::string(texts)), ...);
  return arguments;
}

/// What the master answers; nothing if it is not there or says no.
std::optional<XmlRpcValue> ask_master(const std::string& method, const XmlRpcValue& arguments) {
  XmlRpcValue response;
  XmlRpcValue answer;
  if (ros::isShuttingDown() || !ros::master::execute(method, arguments, response, answer, false))
    return std::nullopt;
  return answer;
}

/// Of the list of [name, [node, …]] those that this node has.
std::vector<std::string> own_of(XmlRpcValue& all) {
  std::vector<std::string> own;
  for (int i = 0; i < all.size(); ++i) {
    XmlRpcValue& nodes = all[i][1];
    for (int n = 0; n < nodes.size(); ++n)
      if (static_cast<std::string&>(nodes[n]) == ros::this_node::getName())
        own.push_back(static_cast<std::string&>(all[i][0]));
  }
  return own;
}

bool ends_with(const std::string& text, const std::string& end) {
  return text.size() > end.size() && text.compare(text.size() - end.size(), end.size(), end) == 0;
}

std::vector<Rival> rivals_for(const std::vector<std::string>& own, XmlRpcValue& published) {
  std::vector<Rival> rivals;
  for (int i = 0; i < published.size(); ++i) {
    const auto& topic = static_cast<std::string&>(published[i][0]);
    if (!ends_with(topic, "/online") || std::find(own.begin(), own.end(), topic) == own.end()) continue;
    XmlRpcValue& nodes = published[i][1];
    for (int n = 0; n < nodes.size(); ++n)
      if (const auto& node = static_cast<std::string&>(nodes[n]); node != ros::this_node::getName())
        rivals.push_back({topic, node});
  }
  return rivals;
}

/// As the master does when a publisher comes: this node connects to those that it does not know yet.
void tell_publishers(const std::string& own_uri, const std::string& topic, const XmlRpcValue& publishers) {
  std::string host;
  std::uint32_t port = 0;
  if (!ros::network::splitURI(own_uri, host, port)) return;
  XmlRpcValue arguments = call(topic);
  arguments[2] = publishers;
  XmlRpcValue ignored;
  XmlRpc::XmlRpcClient self(host.c_str(), static_cast<int>(port), "/");
  self.execute("publisherUpdate", arguments, ignored);
}

}  // namespace

Registrations::Registrations()
    : own_uri_(ros::XMLRPCManager::instance()->getServerURI()),
      service_uri_(fmt::format("rosrpc://{}:{}", ros::network::getHost(),
                               ros::ConnectionManager::instance()->getTCPPort())) {}

Registrations::Known Registrations::ask() const {
  XmlRpcValue response;
  XmlRpcValue ignored;
  const std::string& name = ros::this_node::getName();
  const bool known = ros::master::execute("lookupNode", call(name), response, ignored, false);
  if (known) return static_cast<std::string&>(response[2]) == own_uri_ ? Known::yes : Known::by_another;
  const bool answered = response.valid() && response.getType() == XmlRpcValue::TypeArray;
  return answered ? Known::no : Known::no_master;
}

void Registrations::learn() {
  auto state = ask_master("getSystemState", call());
  auto types = ask_master("getTopicTypes", call());
  if (!state || !types) return;
  published_ = own_of((*state)[0]);
  rivals_ = rivals_for(published_, (*state)[0]);
  subscribed_ = own_of((*state)[1]);
  services_ = own_of((*state)[2]);
  for (int i = 0; i < types->size(); ++i)
    types_[static_cast<std::string&>((*types)[i][0])] = static_cast<std::string&>((*types)[i][1]);
  XmlRpcValue parameters;
  if (ros::param::get(ros::this_node::getName(), parameters)) parameters_ = parameters;
}

bool Registrations::tell() const {
  const auto type_of = [this](const std::string& topic) {
    const auto known = types_.find(topic);
    return known == types_.end() ? "*" : known->second;
  };
  bool all = true;
  // First: who waits for the topics may read them then.
  if (parameters_.valid() && !ros::param::has(ros::this_node::getName()))
    ros::param::set(ros::this_node::getName(), parameters_);
  for (const std::string& service : services_)
    all &= ask_master("registerService", call(service, service_uri_, own_uri_)).has_value();
  for (const std::string& topic : published_)
    all &= ask_master("registerPublisher", call(topic, type_of(topic), own_uri_)).has_value();
  for (const std::string& topic : subscribed_) {
    const auto publishers = ask_master("registerSubscriber", call(topic, type_of(topic), own_uri_));
    all &= publishers.has_value();
    if (publishers) tell_publishers(own_uri_, topic, *publishers);
  }
  return all;
}

}  // namespace coupler::host
