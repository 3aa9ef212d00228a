// SPDX-License-Identifier: Apache-2.0
// Waiting for changes (function code 65), both directions. docs/time.md has the bytes.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <tl/expected.hpp>

#include "coupler/base/span.hpp"
#include "coupler/modbus/node_time.hpp"
#include "coupler/modbus/pdu.hpp"

namespace coupler::modbus {

/// Why a scheduled output was not driven, or not for as long as it should.
enum class Reason : std::uint8_t {
  none = 0,
  client = 1,       ///< cancelled by the client that scheduled it
  overwritten = 2,  ///< another write to the same point came first
  watchdog = 3,     ///< the watchdog expired
  safe_state = 4,   ///< the outputs went to their safe state for another reason
  reload = 5,       ///< the node reads a new map, loses or finds a chip, or ends
  connection = 6,   ///< the connection that scheduled it has ended
  hardware = 7,     ///< the output could not be driven, or does not take the value any more
  locked = 8,       ///< the watchdog keeps outputs in their safe state until it is reset
};

/// An event at a node.
struct Change {
  /// Others may come from a newer node and mean nothing here. 2 is reserved: a register changed.
  enum class Kind : std::uint8_t {
    off = 0,        ///< the bit is 0
    on = 1,         ///< the bit is 1
    done = 3,       ///< a scheduled output was driven
    cancelled = 4,  ///< a scheduled output will not be driven
    failed = 5,     ///< a scheduled output could not be driven
  };

  /// The function code that reads the bit (1 or 2); for scheduled outputs a Reason.
  std::uint8_t table = 0;
  Kind kind = Kind::off;
  /// The address of the bit, or for scheduled outputs the number that ScheduleReply has.
  std::uint16_t address = 0;
  /// The kernel's stamp of an edge; otherwise when it was done.
  NodeTime at{};

  constexpr bool is_bit() const { return kind == Kind::off || kind == Kind::on; }
  friend constexpr bool operator==(const Change& a, const Change& b) {
    return a.table == b.table && a.kind == b.kind && a.address == b.address && a.at == b.at;
  }
};

constexpr std::uint16_t longest_wait = 30000;  ///< ms
constexpr std::size_t max_changes = 18;        ///< in one reply
constexpr std::size_t changes_request_size = 16;

/// Asks for what changed after the change number `seen` of `epoch`. The node answers when there is something,
/// or after the longest wait.
struct ChangesRequest {
  std::uint16_t wait = 0;   ///< the longest wait in ms, 0 … longest_wait
  std::uint32_t epoch = 0;  ///< of the last reply; 0 at first
  std::uint64_t seen = 0;   ///< number of the last change that has come
};

struct ChangesReply {
  std::uint32_t epoch = 0;   ///< numbers of another epoch mean nothing: all is to be read once
  NodeTime arrived{};        ///< the request
  NodeTime replied{};        ///< this reply
  std::uint64_t newest = 0;  ///< number of the newest change; what does not follow here can be asked for
  std::uint32_t lost = 0;    ///< changes after `seen` that are not known any more: all is to be read once
  std::uint8_t count = 0;    ///< of `changes`: those with the numbers seen + lost + 1 and up
  std::array<Change, max_changes> changes{};

  Span<const Change> all() const { return Span<const Change>(changes).first(count); }
};

// The client's side.

/// Writes the request PDU into `pdu`, which holds at least changes_request_size bytes. Returns its size.
std::size_t build_changes_request(const ChangesRequest& request, Span<std::uint8_t> pdu);

/// Changes of a kind or table that is not known here are among them.
tl::expected<ChangesReply, ReplyError> parse_changes_reply(Bytes pdu);

// The server's side.

/// `pdu` has at least one byte. Error: 03 a length, version or wait that is not allowed.
tl::expected<ChangesRequest, Exception> parse_changes_request(Bytes pdu);

/// `pdu` holds at least max_pdu_size bytes. Returns the size.
std::size_t reply_changes(const ChangesReply& reply, Span<std::uint8_t> pdu);

}  // namespace coupler::modbus
