// SPDX-License-Identifier: Apache-2.0
#include "coupler/device/net/loop.hpp"

#include <algorithm>
#include <cassert>

namespace coupler::device {
namespace {

epoll_event event_for(Interest interest, EventHandler& handler) {
  epoll_event event{};
  event.events = static_cast<std::uint32_t>(interest);
  event.data.ptr = &handler;
  return event;
}

}  // namespace

Loop::Loop() : epoll_(::epoll_create1(EPOLL_CLOEXEC)) {}

bool Loop::watch(int fd, Interest interest, EventHandler& handler) {
  epoll_event event = event_for(interest, handler);
  return ::epoll_ctl(epoll_.get(), EPOLL_CTL_ADD, fd, &event) == 0;
}

void Loop::change(int fd, Interest interest, EventHandler& handler) {
  epoll_event event = event_for(interest, handler);
  [[maybe_unused]] const int result = ::epoll_ctl(epoll_.get(), EPOLL_CTL_MOD, fd, &event);
  assert(result == 0);
}

void Loop::forget(int fd, const EventHandler& handler) {
  ::epoll_ctl(epoll_.get(), EPOLL_CTL_DEL, fd, nullptr);
  for (int i = 0; i < waiting_; ++i) {
    epoll_event& event = events_[static_cast<std::size_t>(i)];
    if (event.data.ptr == &handler) event.data.ptr = nullptr;
  }
}

TimePoint Loop::run_once(std::optional<std::chrono::milliseconds> timeout) {
  const int wait = timeout ? static_cast<int>(timeout->count()) : -1;
  waiting_ = std::max(0, ::epoll_wait(epoll_.get(), events_.data(), static_cast<int>(events_.size()), wait));
  for (int i = 0; i < waiting_; ++i)
    if (void* handler = events_[static_cast<std::size_t>(i)].data.ptr)
      static_cast<EventHandler*>(handler)->ready(TimePoint::clock::now());
  waiting_ = 0;
  return TimePoint::clock::now();
}

}  // namespace coupler::device
