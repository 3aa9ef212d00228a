// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/panel/incoming_requests.hpp"

#include <poll.h>

#include <algorithm>
#include <chrono>
#include <iterator>
#include <utility>

namespace coupler::host {

IncomingRequests::IncomingRequests(Handler handle) : handle_(std::move(handle)), thread_([this] { run(); }) {}

IncomingRequests::~IncomingRequests() {
  ending_ = true;
  wakeup_.call();
  thread_.join();
}

void IncomingRequests::add(std::unique_ptr<RequestStream> stream) {
  {
    const std::lock_guard lock(mutex_);
    added_.push_back(std::move(stream));
  }
  wakeup_.call();
}

void IncomingRequests::run() {
  while (!ending_) {
    {
      const std::lock_guard lock(mutex_);
      std::move(added_.begin(), added_.end(), std::back_inserter(streams_));
      added_.clear();
    }
    wait();
    gather();
    if (streams_.size() > most) streams_.erase(streams_.begin(), streams_.end() - most);
  }
}

/// Until bytes of one come, one is to be given up, or another is added.
void IncomingRequests::wait() {
  wanted_.assign({{wakeup_.fd(), POLLIN, 0}});
  Time until = Time::max();
  for (const auto& stream : streams_) {
    wanted_.push_back({stream->socket(), stream->wants(), 0});
    until = std::min(until, stream->until());
  }
  int left = -1;
  if (until != Time::max()) {
    const auto time = std::chrono::ceil<std::chrono::milliseconds>(until - std::chrono::steady_clock::now());
    left = static_cast<int>(std::max<std::chrono::milliseconds::rep>(time.count(), 0));
  }
  ::poll(wanted_.data(), wanted_.size(), left);
  wakeup_.clear();
}

void IncomingRequests::gather() {
  const Time now = std::chrono::steady_clock::now();
  for (std::size_t i = 0; i < streams_.size(); ++i) {
    auto& stream = streams_[i];
    if (wanted_[i + 1].revents != 0) stream->gather();
    if (stream->has_request())
      handle_(std::move(stream));
    else if (stream->wants() == 0 || stream->until() <= now)
      stream = nullptr;
  }
  streams_.erase(std::remove(streams_.begin(), streams_.end(), nullptr), streams_.end());
}

}  // namespace coupler::host
