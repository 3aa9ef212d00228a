// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <future>
#include <optional>
#include <string>
#include <string_view>

#include "coupler/host/core/write.hpp"

namespace coupler::client {

/// What became of a value that was set.
struct SetResult {
  using Outcome = host::WriteResult::Outcome;

  Outcome outcome = Outcome::ok;
  std::optional<modbus::Exception> exception{};  ///< that the device answered with
  std::string text;                              ///< what happened, in words that follow the point's name

  /// The device has taken the value.
  explicit operator bool() const { return outcome == Outcome::ok; }
};

/// get() waits for the device's answer: a few of its timeouts at most. It must not be waited for in a
/// callback, since the answer comes by the same thread. It need not be waited for at all.
using PendingWrite = std::future<SetResult>;

/// The result of a value that is none of its point: known at once.
PendingWrite refused(std::string_view why);

/// Makes `write` tell the future its result. The write must be pushed, or the listener told.
PendingWrite listen_to(host::Write& write);

}  // namespace coupler::client
