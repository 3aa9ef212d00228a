// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "coupler/base/span.hpp"
#include "coupler/modbus/pdu.hpp"

namespace coupler::host {

/// What became of a write. Every write has exactly one result.
struct WriteResult {
  enum class Outcome : std::uint8_t {
    ok,          ///< acknowledged by the device, and read back where the map asks for that
    superseded,  ///< a newer value of the same point took its place before it was sent, or its safe value
    exception,   ///< the device answered with an exception
    not_taken,   ///< acknowledged, but something else (or nothing) reads back
    lost,        ///< sent, and the link broke before the answer: it may have been carried out or not
    dropped,     ///< never sent: not connected, or too many writes wait
    kept,        ///< not connected: written when the device is back, unless a newer value comes before
    refused      ///< not a value of that point
  };
  static constexpr std::size_t outcomes = 8;

  Outcome outcome = Outcome::ok;
  std::optional<modbus::Exception> exception{};  ///< of the write, or with not_taken of the read-back
  std::string_view why{};                        ///< lost, dropped, refused; valid during the call
  Span<const std::uint16_t> written{};           ///< not_taken, as Point::initial; valid during the call
  Span<const std::uint16_t> found{};  ///< not_taken: what reads back; empty if nothing could be read
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

/// Waits for the result of a write.
class WriteListener {
 public:
  /// Called once, from any thread (also from within the call that makes the write). It must wait for nothing.
  virtual void on_result(const WriteResult& result) = 0;

 protected:
  ~WriteListener() = default;
};

}  // namespace coupler::host
