// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/ros1/master_watch.hpp"

#include <ros/init.h>
#include <ros/master.h>
#include <ros/this_node.h>

#include <chrono>
#include <utility>

#include <fmt/format.h>

namespace coupler::host {
namespace {

using Known = Registrations::Known;

/// A restarted master finds the node again within this and what the registration takes.
constexpr auto interval = std::chrono::seconds(2);
constexpr unsigned looks_to_learn = 5;

std::string master_uri() { return fmt::format("the ROS master at {}", ros::master::getURI()); }

}  // namespace

MasterWatch::MasterWatch(Log& log) : log_(log), recurring_(interval, [this] { look(); }) {}

/// What the master knows changes seldom, and may be much.
void MasterWatch::learn() {
  if (looks_++ % looks_to_learn != 0) return;
  registrations_.learn();
  rivals_.warn_of(registrations_.rivals(), log_);
}

void MasterWatch::look() {
  const Known before = std::exchange(known_, registrations_.ask());
  if (ros::isShuttingDown()) return;  // and has said good-bye to the master
  switch (known_) {
    case Known::yes: return learn();
    case Known::no_master:
      if (before == Known::yes)
        log_.log(Level::warning,
                 master_uri() +
                     " does not answer; devices are polled and fed, and topics that are connected go on");
      return;
    case Known::by_another:
      if (before != Known::by_another)
        log_.log(Level::error,
                 fmt::format(
                     "{} knows another node as {}; new subscribers do not find this one. End one of the two",
                     master_uri(), ros::this_node::getName()));
      return;
    case Known::no: break;
  }
  if (registrations_.tell())
    log_.log(Level::warning,
             master_uri() + " has started again; topics, services and parameters are registered anew");
  else
    known_ = before == Known::yes ? Known::no_master : before;  // it went again; the next look tells
}

}  // namespace coupler::host
