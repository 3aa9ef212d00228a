// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/ros1/master_watch.hpp"

#include <XmlRpcClient.h>
#include <XmlRpcException.h>
#include <ros/connection_manager.h>
#include <ros/init.h>
#include <ros/master.h>
#include <ros/network.h>
#include <ros/param.h>
#include <ros/this_node.h>
#include <ros/xmlrpc_manager.h>

#include <algorithm>
#include <chrono>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "coupler/host/ros1/xmlrpc_calls.hpp"

namespace coupler::host {
namespace {

using Known = Registrations::Known;
using XmlRpc::XmlRpcValue;

/// A restarted master finds the node again within this and what the registration takes.
constexpr auto interval = std::chrono::seconds(2);
constexpr unsigned checks_per_update = 5;

std::string master_uri() { return fmt::format("the ROS master at {}", ros::master::getURI()); }

/// Returns the names in the list of [name, [node, …]] that have this node.
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

std::vector<DuplicateDriver> duplicates_of(const std::vector<std::string>& own, XmlRpcValue& published) {
  std::vector<DuplicateDriver> duplicates;
  for (int i = 0; i < published.size(); ++i) {
    const auto& topic = static_cast<std::string&>(published[i][0]);
    if (!ends_with(topic, "/online") || std::find(own.begin(), own.end(), topic) == own.end()) continue;
    XmlRpcValue& nodes = published[i][1];
    for (int n = 0; n < nodes.size(); ++n)
      if (const auto& node = static_cast<std::string&>(nodes[n]); node != ros::this_node::getName())
        duplicates.push_back({topic, node});
  }
  return duplicates;
}

/// Adds the ends of other nodes to `others`, from a list of [topic, [node, …]].
void add_others(XmlRpcValue& all, bool publishes, const TopicCheck& topics, std::vector<Endpoint>& others) {
  for (int i = 0; i < all.size(); ++i) {
    const auto& topic = static_cast<std::string&>(all[i][0]);
    if (!topics.concerns(topic)) continue;
    XmlRpcValue& nodes = all[i][1];
    for (int n = 0; n < nodes.size(); ++n)
      if (const auto& node = static_cast<std::string&>(nodes[n]); node != ros::this_node::getName())
        others.push_back({topic, node, publishes, {}});
  }
}

/// Does what the master does when there is a new publisher: this node connects to those that it does not know
/// yet.
void connect_to_publishers(const std::string& own_uri, const std::string& topic,
                           const XmlRpcValue& publishers) {
  std::string host;
  std::uint32_t port = 0;
  if (!ros::network::splitURI(own_uri, host, port)) return;
  XmlRpcValue arguments = call_arguments(topic);
  arguments[2] = publishers;
  XmlRpcValue ignored;
  XmlRpc::XmlRpcClient self(host.c_str(), static_cast<int>(port), "/");
  self.execute("publisherUpdate", arguments, ignored);
}

}  // namespace

Registrations::Registrations(const TopicCheck& topics)
    : topics_(topics),
      own_uri_(ros::XMLRPCManager::instance()->getServerURI()),
      service_uri_(fmt::format("rosrpc://{}:{}", ros::network::getHost(),
                               ros::ConnectionManager::instance()->getTCPPort())) {}

Registrations::Known Registrations::check() const {
  XmlRpcValue response;
  XmlRpcValue ignored;
  const std::string& name = ros::this_node::getName();
  const bool known = ros::master::execute("lookupNode", call_arguments(name), response, ignored, false);
  if (known) return static_cast<std::string&>(response[2]) == own_uri_ ? Known::yes : Known::by_another;
  const bool answered = response.valid() && response.getType() == XmlRpcValue::TypeArray;
  return answered ? Known::no : Known::no_master;
}

void Registrations::update() {
  auto state = ask_master("getSystemState", call_arguments());
  auto types = ask_master("getTopicTypes", call_arguments());
  if (!state || !types) return;
  published_ = own_of((*state)[0]);
  duplicates_ = duplicates_of(published_, (*state)[0]);
  subscribed_ = own_of((*state)[1]);
  services_ = own_of((*state)[2]);
  others_.clear();
  add_others((*state)[0], true, topics_, others_);
  add_others((*state)[1], false, topics_, others_);
  for (int i = 0; i < types->size(); ++i)
    types_[static_cast<std::string&>((*types)[i][0])] = static_cast<std::string&>((*types)[i][1]);
  XmlRpcValue parameters;
  if (ros::param::get(ros::this_node::getName(), parameters)) parameters_ = parameters;
}

bool Registrations::restore() const {
  const auto type_of = [this](const std::string& topic) {
    const auto known = types_.find(topic);
    return known == types_.end() ? "*" : known->second;
  };
  bool all = true;
  // First: who waits for the topics may read the parameters then.
  if (parameters_.valid() && !ros::param::has(ros::this_node::getName()))
    ros::param::set(ros::this_node::getName(), parameters_);
  for (const std::string& service : services_)
    all &= ask_master("registerService", call_arguments(service, service_uri_, own_uri_)).has_value();
  for (const std::string& topic : published_)
    all &= ask_master("registerPublisher", call_arguments(topic, type_of(topic), own_uri_)).has_value();
  for (const std::string& topic : subscribed_) {
    const auto publishers = ask_master("registerSubscriber", call_arguments(topic, type_of(topic), own_uri_));
    all &= publishers.has_value();
    if (publishers) connect_to_publishers(own_uri_, topic, *publishers);
  }
  return all;
}

MasterWatch::MasterWatch(Node& log, const TopicCheck& topics)
    : log_(log), topics_(topics), registrations_(topics), thread_(interval, [this] { try_check(); }) {}

/// A master of another make may answer in a shape that is none of ROS's.
void MasterWatch::try_check() {
  try {
    check();
    told_ = false;
  } catch (const XmlRpc::XmlRpcException& error) {
    if (std::exchange(told_, true)) return;
    log_.log(Level::warning,
             fmt::format("the answer of {} cannot be read: {}; if it has started again, new subscribers do "
                         "not find this node",
                         master_uri(), error.getMessage()));
  }
}

void MasterWatch::warn(const std::vector<std::string>& lines) {
  for (const std::string& line : lines) log_.log(Level::warning, line);
}

/// The master's data changes seldom, and may be large.
void MasterWatch::update() {
  if (updates_++ % checks_per_update != 0) return;
  registrations_.update();
  warn(duplicates_.update(findings_of(registrations_.duplicates()), "drivers"));
  std::vector<Endpoint> others = registrations_.others();
  types_.fill(others, topics_);
  warn(wrong_topics_.update(topics_.check(others),
                            "publishers and subscribers at a wrong place or with a wrong type"));
}

void MasterWatch::check() {
  const Known before = std::exchange(known_, registrations_.check());
  if (ros::isShuttingDown()) return;  // this node is unregistered
  switch (known_) {
    case Known::yes: return update();
    case Known::no_master:
      if (before == Known::yes)
        log_.log(
            Level::warning,
            master_uri() +
                " does not answer; devices are polled and their watchdogs fed, and connected topics go on");
      return;
    case Known::by_another:
      if (before != Known::by_another)
        log_.log(Level::error, fmt::format("{} knows another node by the name {}; new subscribers do not "
                                           "find this one. Stop one of the two",
                                           master_uri(), ros::this_node::getName()));
      return;
    case Known::no: break;
  }
  if (registrations_.restore())
    log_.log(Level::warning,
             master_uri() + " has started again; topics, services and parameters are registered again");
  else
    known_ = before == Known::yes ? Known::no_master : before;  // it is gone again: the next check reports it
}

}  // namespace coupler::host
