// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "coupler/device/core/server.hpp"

namespace coupler::device {

class Connection;

/// The connections that wait for changes. Allocates at the start only.
class Waiters {
 public:
  /// Room for so many. The server outlives it.
  Waiters(const Server& server, std::size_t capacity) : server_(server) { all_.reserve(capacity); }

  /// The connection waits, until then at the latest.
  void add(Connection& connection, TimePoint until) { all_.push_back({&connection, until}); }
  void remove(const Connection& connection);

  /// When answer() has something to do; nullopt: when there is a change.
  std::optional<TimePoint> due() const;
  /// Has those answer that are due: all if there is a change since the last call.
  void answer(TimePoint now);

 private:
  struct Waiter {
    Connection* connection;
    TimePoint until;
  };
  bool is_news() const { return server_.changes().ring().newest() != told_; }

  const Server& server_;
  std::vector<Waiter> all_;
  std::uint64_t told_ = 0;  ///< number of the newest change that they were told of
};

}  // namespace coupler::device
