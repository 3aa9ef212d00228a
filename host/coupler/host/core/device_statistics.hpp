// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <mutex>
#include <optional>
#include <string>

#include "coupler/host/core/channel.hpp"
#include "coupler/host/core/error.hpp"
#include "coupler/host/core/identity_check.hpp"
#include "coupler/host/core/request_counts.hpp"
#include "coupler/host/core/write.hpp"

namespace coupler::host {

/// The state of the coupler's own watchdog.
struct WatchdogStatus {
  enum class State : std::uint8_t {
    not_fed,  ///< not connected, or arming failed
    fed,      ///< armed, if the host can arm it
    expired   ///< the outputs are as the coupler leaves them
  };
  State state = State::not_fed;
  std::uint64_t expiries = 0;  ///< the number of expiries that were noticed
  std::string error_text;      ///< what is wrong and what to do, while it is expired or could not be armed
};

/// The state of a device, and what was done with it since the program began.
struct DeviceCounts {
  bool online = false;
  std::string trouble;                        ///< the reason why it is not online
  std::optional<Identity::Verdict> identity;  ///< at the last connect; nullopt: not asked
  identity::Machine machine{};                ///< that of a node at the last connect, as far as it is known
  std::uint64_t connections = 0;              ///< proven ones; all but the first are reconnects
  std::uint64_t rejected_ranges = 0;
  std::uint64_t overruns = 0;
  std::uint64_t changes = 0;       ///< the number of changes that a node has told
  std::uint64_t changes_lost = 0;  ///< the number of changes that it could not tell any more
  std::array<std::uint64_t, WriteResult::outcomes> writes{};  ///< by outcome
  WatchdogStatus watchdog;                                    ///< the coupler's own
  std::optional<Certificates> certificates;                   ///< those of the last connection, if it has TLS
  Histogram cycles;  ///< from the deadline of a polling cycle to its last reply

  std::uint64_t written(WriteResult::Outcome outcome) const {
    return writes[static_cast<std::size_t>(outcome)];
  }
};

/// A device at one moment.
struct DeviceSnapshot : DeviceCounts, RequestCounts {
  std::uint64_t discarded = 0;  ///< Link::discarded()
};

/// Counts what a device does, but not its requests, which Link counts. Any thread may read the counts. Only
/// error texts allocate memory.
class DeviceStatistics {
 public:
  void wrote(WriteResult::Outcome outcome);
  void cycle_ended(Duration after, std::uint64_t overruns);
  void rejected();
  void heard(std::uint64_t changes, std::uint64_t lost);
  void watchdog(const WatchdogStatus& status);
  void identified(Identity::Verdict verdict, const identity::Machine& machine);
  void online(const std::optional<Certificates>& certificates);
  void offline(const std::string& trouble);

  DeviceCounts counts() const;
  /// A number that changes whenever `online`, `trouble` or `identity` is set.
  std::uint64_t revision() const { return revision_; }

 private:
  mutable std::mutex mutex_;
  DeviceCounts now_;
  std::atomic<std::uint64_t> revision_{0};
};

}  // namespace coupler::host
