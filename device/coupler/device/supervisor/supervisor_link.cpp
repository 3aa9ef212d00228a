// SPDX-License-Identifier: Apache-2.0
#include "coupler/device/supervisor/supervisor_link.hpp"

#include <cassert>
#include <utility>

#include "coupler/device/supervisor/channel.hpp"

namespace coupler::device {

void SupervisorLink::watch(Loop& loop) {
  loop_ = &loop;
  [[maybe_unused]] const bool watched = loop.watch(channel_.get(), Interest::read, *this);
  assert(watched);
}

void SupervisorLink::beat() { channel::send(channel_.get(), channel::Beat{}); }

void SupervisorLink::give(const OpenConnection& client) { channel::send(channel_.get(), client); }

bool SupervisorLink::is_silent(TimePoint now) {
  silence_.sample(now, std::exchange(heard_, false), std::chrono::nanoseconds(0));
  return silence_.lasted() >= timeout;
}

void SupervisorLink::ready(TimePoint) {
  const channel::Message message = channel::receive(channel_.get());
  heard_ |= std::holds_alternative<channel::Beat>(message);
  if (std::holds_alternative<channel::MakeRoom>(message)) wants_room_ = true;
  // The kernel sends SIGTERM when the supervisor dies; until then there is nothing to be heard.
  if (std::holds_alternative<channel::Ended>(message))
    loop_->change(channel_.get(), Interest::nothing, *this);
}

}  // namespace coupler::device
