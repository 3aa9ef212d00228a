// SPDX-License-Identifier: Apache-2.0
// A value on its way to the device, and what became of it.
#pragma once

#include <array>
#include <condition_variable>
#include <cstdint>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "coupler/base/span.hpp"
#include "coupler/host/core/clock.hpp"
#include "coupler/map/map.hpp"
#include "coupler/modbus/limits.hpp"
#include "coupler/modbus/pdu.hpp"

namespace coupler::host {

/// What became of a write. Every write has exactly one result.
struct WriteResult {
  enum class Outcome : std::uint8_t {
    ok,          ///< acknowledged by the device, and read back where the map asks for that
    superseded,  ///< a newer value of the same point took its place before it was sent, or its safe value
    exception,   ///< the device answered with an exception
    not_taken,   ///< acknowledged with another value, or something else (or nothing) reads back
    lost,        ///< sent, but the connection broke before the answer: it may have been carried out or not
    dropped,     ///< never sent: not connected, too many writes wait, or it waited longer than it may
    kept,        ///< not connected: written when the device is back, unless a newer value comes before
    refused      ///< not a value of that point
  };
  static constexpr std::size_t outcomes = 8;

  Outcome outcome = Outcome::ok;
  std::optional<modbus::Exception> exception{};  ///< of the write, or with not_taken of the read-back
  std::string_view
      why{};  ///< exception, lost, dropped, refused, not_taken by its acknowledgement; valid during the call
  Span<const std::uint16_t> written{};  ///< not_taken, as Point::initial; valid during the call
  Span<const std::uint16_t> found{};    ///< not_taken: what reads back; empty if nothing could be read
};

/// As messages have it, where 0 is none.
constexpr std::uint8_t outcome_number(WriteResult::Outcome outcome) {
  return static_cast<std::uint8_t>(static_cast<std::uint8_t>(outcome) + 1);
}

/// "ok", "superseded", …, "not taken"; each is another word.
std::string_view to_string(WriteResult::Outcome outcome);

/// What happened; it begins with the outcome's word: "exception 02 (illegal data address)", "lost: no reply
/// …".
std::string to_string(const WriteResult& result);

/// Gets the result of a write.
class WriteListener {
 public:
  /// Called once, from any thread (also from within the call that makes the write). It must wait for nothing.
  virtual void on_result(const WriteResult& result) = 0;

 protected:
  ~WriteListener() = default;
};

/// Waits for the result of one write. It must not be used in a thread that the result needs: the
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
    known_.notify_all();  // under the lock: the waiting thread may destroy the ticket as soon as it is free
  }

  /// Waits until the write has its result: a few timeouts of the device at most.
  Outcome wait() {
    std::unique_lock lock(mutex_);
    known_.wait(lock, [this] { return outcome_.has_value(); });
    return *outcome_;
  }

 private:
  std::mutex mutex_;
  std::condition_variable known_;
  std::optional<Outcome> outcome_;
};

/// A value on its way to the device, encoded. It owns its registers, so that a queue of them allocates
/// nothing.
struct Write {
  std::uint32_t point = 0;  ///< index into Map::points
  /// range(point).count() of them are used. Coils: bit i % 16 of element i / 16, so that one coil is the
  /// first, 0 or 1.
  std::array<std::uint16_t, modbus::max_read_registers> registers{};
  bool ordered = false;               ///< keeps its place in the queue: its caller waits for its own result
  bool of_deadman = false;            ///< made by the driver because no message came
  bool of_schedule = false;           ///< made by the driver because its time has come
  Time until = Time::max();           ///< if it still waits then, it is dropped
  WriteListener* listener = nullptr;  ///< gets the result; lives until then

  bool bit(std::size_t i) const { return (registers[i / 16] >> i % 16 & 1U) != 0; }
  void set_bit(std::size_t i) {
    registers[i / 16] = static_cast<std::uint16_t>(registers[i / 16] | 1U << i % 16);
  }
};

/// A write of a value as a point's `initial`, `safe_value` and deadman have it: one element for each bit in
/// bit tables. Empty is all zero.
Write make_write(const Map& map, std::uint32_t point, Span<const std::uint16_t> value);

/// The safe value of each output, by Point::safe and Point::safe_value; none for those that hold theirs. A
/// register without a safe value of its own is left alone unless it is an analogue output.
std::vector<Write> safe_values(const Map& map);

}  // namespace coupler::host
