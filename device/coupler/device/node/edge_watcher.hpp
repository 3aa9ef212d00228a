// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fmt/format.h>

#include <cerrno>
#include <cstring>

#include "coupler/device/core/log.hpp"
#include "coupler/device/gpio/event_source.hpp"
#include "coupler/device/net/loop.hpp"

namespace coupler::device {

/// Takes edges from the kernel as they come; a line that is gone is not watched any more.
class EdgeWatcher : public Watcher {
 public:
  EdgeWatcher(Loop& loop, EventSource& source, Log& log) : loop_(loop), source_(source) {
    if (!loop_.watch(source_.descriptor(), Interest::read, *this))
      log.write(fmt::format("an input's edges are seen late, when it is read: {}", std::strerror(errno)));
  }
  EdgeWatcher(const EdgeWatcher&) = delete;
  EdgeWatcher& operator=(const EdgeWatcher&) = delete;
  ~EdgeWatcher() { loop_.forget(source_.descriptor(), *this); }

  void ready(TimePoint) override {
    if (!source_.take_edges()) loop_.forget(source_.descriptor(), *this);
  }

 private:
  Loop& loop_;
  EventSource& source_;
};

}  // namespace coupler::device
