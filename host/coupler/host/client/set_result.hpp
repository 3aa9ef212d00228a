// SPDX-License-Identifier: Apache-2.0
// Holds the results of setting values.
#pragma once

#include <future>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "coupler/host/core/write.hpp"

namespace coupler::client {

/// The result of setting a value.
struct SetResult {
  using Outcome = host::WriteResult::Outcome;

  Outcome outcome = Outcome::ok;
  std::optional<modbus::Exception> exception{};  ///< that the device answered with
  std::string
      text;  ///< what happened, in words that follow the point's name; of several values they begin with it

  /// The device has taken the value.
  explicit operator bool() const { return outcome == Outcome::ok; }
};

/// get() waits for the device's answer: a few of its timeouts at most. A callback must not wait for it, since
/// the answer comes in the same thread. It may be ignored.
using PendingWrite = std::future<SetResult>;

/// The result of a value that is not valid for its point: known at once. `name` is the point's where the
/// value is one of several.
PendingWrite refused(std::string_view why, std::string_view name = {});

/// Makes the write give its result to the future. It must be pushed, or its listener called.
PendingWrite listen_to(host::Write& write);

/// Makes the writes, of which there is one at least, give one result to the future when each has its own:
/// that of the first one that failed, or that of all. They must be pushed, or their listeners called.
PendingWrite listen_to_all(std::vector<host::Write>& writes, const Map& map);

}  // namespace coupler::client
