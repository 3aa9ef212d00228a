// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <condition_variable>
#include <mutex>
#include <string>

#include "coupler/host/core/write_result.hpp"

namespace coupler::host {

/// For one who can wait: the result of one write. It must not be used in a thread that the result needs: the
/// connection's, or ROS's network thread.
class WriteTicket : public WriteListener {
 public:
  struct Outcome {
    WriteResult::Outcome outcome = WriteResult::Outcome::ok;
    std::optional<modbus::Exception> exception{};
    std::string text;
  };

  void on_result(const WriteResult& result) override {
    const std::lock_guard lock(mutex_);
    outcome_ = Outcome{result.outcome, result.exception, to_string(result)};
    told_.notify_all();  // under the lock: the one who waits may destroy the ticket as soon as it is free
  }

  /// Until the write has its result: a few timeouts of the device at most.
  Outcome wait() {
    std::unique_lock lock(mutex_);
    told_.wait(lock, [this] { return outcome_.has_value(); });
    return *outcome_;
  }

 private:
  std::mutex mutex_;
  std::condition_variable told_;
  std::optional<Outcome> outcome_;
};

}  // namespace coupler::host
