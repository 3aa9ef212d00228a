// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "exchange.hpp"

namespace coupler::bench {

/// A Modbus client with one request in flight. What must not happen in a benchmark (no connection, a wrong
/// reply) ends the program with status 1 and a line on stderr.
class LockStepClient {
 public:
  using Clock = std::chrono::steady_clock;

  /// Connects to 127.0.0.1, waits for at most `patience` seconds.
  explicit LockStepClient(std::uint16_t port);
  LockStepClient(const LockStepClient&) = delete;
  LockStepClient& operator=(const LockStepClient&) = delete;
  ~LockStepClient();

  int socket() const { return socket_; }

  /// Sends the request. `exchange` stays where it is until the reply is there.
  void ask(const Exchange& exchange);
  /// Takes what is there of the reply; the time since ask() once it is whole and right.
  std::optional<Clock::duration> take();
  /// Asks and waits for the reply.
  void ask_and_wait(const Exchange& exchange);

  /// The server has closed the connection. Only between exchanges.
  bool was_closed() const;

 private:
  static constexpr std::size_t max_size = 260;

  int socket_;
  std::uint16_t transaction_ = 0;
  const Exchange* exchange_ = nullptr;
  Clock::time_point asked_;
  std::array<std::uint8_t, max_size> received_{};
  std::size_t size_ = 0;
};

/// Prints what went wrong and ends the program with status 1.
[[noreturn]] void give_up(const char* what);

}  // namespace coupler::bench
