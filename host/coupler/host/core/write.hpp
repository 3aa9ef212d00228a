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

/// The result of a write. Every write has exactly one.
struct WriteResult {
  enum class Outcome : std::uint8_t {
    ok,          ///< the device acknowledged it, and it reads back if the map asks for that
    superseded,  ///< a newer value of the same point, or its safe value, replaced it before it was sent
    exception,   ///< the device answered with an exception
    not_taken,   ///< the device acknowledged another value, or another value or none reads back
    lost,        ///< the connection broke between request and reply; the write may have been carried out
    dropped,     ///< never sent: not connected, too many writes are queued, or it waited longer than it may
    kept,        ///< not connected; sent when the device is back, unless a newer value comes first
    refused      ///< the point cannot have this value
  };
  static constexpr std::size_t outcomes = 8;

  Outcome outcome = Outcome::ok;
  std::optional<modbus::Exception> exception{};  ///< that of the write; with not_taken that of the read-back
  std::string_view
      why{};  ///< exception, lost, dropped, refused, not_taken by its acknowledgement; valid during the call
  Span<const std::uint16_t> written{};  ///< not_taken, as Point::initial; valid during the call
  Span<const std::uint16_t> found{};  ///< not_taken: the value that reads back; empty if it could not be read
};

/// The exception code as messages have it: 0 is none.
constexpr std::uint8_t outcome_number(WriteResult::Outcome outcome) {
  return static_cast<std::uint8_t>(static_cast<std::uint8_t>(outcome) + 1);
}

/// "ok", "superseded", …, "not taken"; each is another word.
std::string_view to_string(WriteResult::Outcome outcome);

/// A text that begins with the outcome's word, as "exception 02 (illegal data address)" or "lost: no reply
/// …".
std::string to_string(const WriteResult& result);

/// Receives the result of a write.
class WriteListener {
 public:
  /// Called once, from any thread, perhaps from within the call that makes the write. It must not wait for
  /// anything.
  virtual void on_result(const WriteResult& result) = 0;

 protected:
  ~WriteListener() = default;
};

/// Waits for the result of one write. It must not be used in the connection's thread or in ROS's network
/// thread, since the result comes from there.
class WriteTicket : public WriteListener {
 public:
  struct Outcome {
    WriteResult::Outcome outcome = WriteResult::Outcome::ok;
    std::optional<modbus::Exception> exception{};
    std::string text;
  };

  void on_result(const WriteResult& result) override {
    const std::lock_guard lock(mutex_);
    outcome_ = Outcome{result.outcome, result.exception, {}};
    known_.notify_all();  // under the lock: the waiting thread may destroy the ticket as soon as it is free
    outcome_->text = to_string(result);  // last: there may be no memory for it
  }

  /// Waits until the write has its result, a few timeouts of the device at most.
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

/// An encoded value on its way to the device. It owns its registers, so that a queue of writes allocates
/// nothing.
struct Write {
  std::uint32_t point = 0;  ///< index into Map::points
  /// range(point).count() elements are used. Coil i is bit i % 16 of element i / 16, so a single coil is
  /// element 0 with 0 or 1.
  std::array<std::uint16_t, modbus::max_read_registers> registers{};
  bool ordered = false;      ///< keeps its place in the queue, because its caller waits for its result
  bool of_deadman = false;   ///< made by the driver, because no message came
  bool of_schedule = false;  ///< made by the driver, because its time has come
  Time until = Time::max();  ///< it is dropped if it is still queued then
  WriteListener* listener = nullptr;  ///< receives the result; must live until then

  bool bit(std::size_t i) const { return (registers[i / 16] >> i % 16 & 1U) != 0; }
  void set_bit(std::size_t i) {
    registers[i / 16] = static_cast<std::uint16_t>(registers[i / 16] | 1U << i % 16);
  }
};

/// Makes a write of a value in the form of a point's `initial` and `safe_value`: bit tables have one element
/// for each bit. An empty value is all zero.
Write make_write(const Map& map, std::uint32_t point, Span<const std::uint16_t> value);

/// Makes a write of a bit, which may be one of a register.
Write make_bit_write(const Map& map, std::uint32_t point, bool on);

/// Returns a write of the safe value for each output, by Point::safe and Point::safe_value, except for those
/// that hold their values. A register that has no safe value is left alone unless it is an analogue output.
std::vector<Write> safe_values(const Map& map);

}  // namespace coupler::host
