// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "coupler/device/core/hooks.hpp"
#include "coupler/device/net/loop.hpp"

namespace coupler::device {

/// Makes a loop turn when a thread of the firmware has set a value; also called when the loop is no more.
/// Without a descriptor it does not: then the value is taken in the loop's own time.
class LoopWaker final : public EventHandler, public Waker {
 public:
  explicit LoopWaker(Loop& loop);

  void wake() override;
  void ready(TimePoint now) override;

 private:
  Descriptor event_;
};

}  // namespace coupler::device
