// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>

#include "coupler/base/span.hpp"
#include "coupler/credentials/validity.hpp"
#include "coupler/host/core/clock.hpp"
#include "coupler/host/core/error.hpp"
#include "coupler/map/table.hpp"
#include "coupler/modbus/changes.hpp"
#include "coupler/modbus/client.hpp"
#include "coupler/modbus/range.hpp"
#include "coupler/modbus/scheduled_output.hpp"

namespace coupler::host {

/// The order of units that share a connection: writes go before reads, in turn
/// (coupler/host/modbus/turns.hpp).
enum class Rank {
  read,
  write,  ///< also the read before a write, and the one that verifies it
  safe    ///< before all others, until another rank is set
};

/// The answer to a wait for changes, and its time.
struct WaitAnswer {
  Result<modbus::ChangesReply> reply;  ///< an error is an exception
  Time sent{};
  Time received{};
};

/// The certificate that one side of a TLS connection shows.
struct Certificate {
  std::string name;  ///< its common name
  std::string role;  ///< of a client; empty: none
  Validity validity;
};

struct Certificates {
  Certificate own;
  Certificate device;
  bool has_pin = false;  ///< the device's is believed for that, beyond its end
};

/// A client's connection to one unit of a Modbus device. One request is in flight at a time, and its reply is
/// awaited for the device's timeout at most. The object belongs to one thread. Another thread may call
/// reserve(), give_back() and send_pdu() while a lock of its own guarantees that the owner is in
/// wait_until(). Any thread may call interrupt() and wake().
class Transport {
 public:
  virtual ~Transport() = default;

  virtual Result<> connect() = 0;
  virtual void close() = 0;
  /// Ends the call in progress. That call and every later one fail at once.
  virtual void interrupt() = 0;

  /// Sends a PDU and waits for the reply. Returns the PDU of the reply, which has passed
  /// modbus::check_reply() and is valid until the next request. An exception is an ExceptionReply. A reply to
  /// a read that came after the timeout is a Timeout.
  virtual Result<modbus::Bytes> exchange(modbus::Bytes pdu) = 0;
  /// The first half of exchange(): sends, and does not wait for the reply. receive_pdu() must follow before
  /// any other request.
  virtual Result<> send_pdu(modbus::Bytes pdu) = 0;
  /// The second half: waits for the reply, until a timeout after the request at most.
  virtual Result<modbus::Bytes> receive_pdu() = 0;

  // Requests, and what their replies mean.

  /// FC 1 or 2: fills `bits` with `range.count()` (at most 2000) elements of 0 or 1.
  Result<> read_bits(Table table, modbus::Range range, std::uint8_t* bits);
  /// FC 3 or 4: fills `registers` with `range.count()` (at most 125) registers.
  Result<> read_registers(Table table, modbus::Range range, std::uint16_t* registers);
  /// Calls read_bits() or read_registers(). A bit becomes 0 or 1.
  Result<> read(Table table, modbus::Range range, std::uint16_t* values);
  /// FC 20 with one group: fills `registers` (1 … 121) from a file.
  Result<> read_file_record(std::uint16_t file, std::uint16_t record, Span<std::uint16_t> registers);
  /// Sends a write. receive() must follow.
  Result<> send(const modbus::WriteRequest& request) { return send_pdu(request.pdu()); }
  /// Waits for the confirmation of a write.
  Result<> receive();
  /// FC 66. Only a node understands it, and only over a connection that can_wait().
  Result<modbus::ScheduleReply> schedule(const modbus::ScheduleRequest& request);

  // Units that share a connection take turns. A transport in front of another one passes these calls on.

  /// Sets the rank of the reads that follow. Rank::safe is the rank of writes, too; otherwise they have
  /// Rank::write.
  virtual void rank(Rank /*rank*/) {}
  enum class Turn { none, read, write };
  /// Waits until a read would be sent at once, or a write if `write_waits`, whichever comes first. That
  /// request or another call must follow. Returns Turn::none after wake() or at `until`.
  virtual Turn await_turn(Time /*until*/, bool /*write_waits*/ = false) { return Turn::read; }
  /// Waits until send_pdu() would not have to wait for another unit's request, or would fail, or until
  /// `ends()` returns true. `ends()` is called at first and after each wake(). A request or give_back() must
  /// follow.
  virtual void await_turn_to_write(const std::function<bool()>& /*ends*/) {}
  /// Returns whether send_pdu() would not have to wait for another unit's request. If it returns true,
  /// send_pdu() or give_back() must follow.
  virtual bool reserve() { return true; }
  /// Gives the turn to the other units, because no request follows.
  virtual void give_back() {}

  // A wait for changes (function code 65) may be outstanding while other requests are made: the device
  // answers it then at once, and before them.

  /// Returns false where units share a connection, and on a serial line.
  virtual bool can_wait() const { return false; }
  /// Sends a wait and does not wait for its answer. No other wait may be outstanding.
  virtual Result<> send_wait(const modbus::ChangesRequest& /*request*/) {
    return fail(NotConnected{"this connection cannot wait for changes"});
  }
  /// Receives the answer. Call it when bytes have come, or a timeout after the end of the wait. The rest of
  /// an answer that has begun is awaited for a timeout at most.
  virtual Result<> receive_wait() { return fail(NotConnected{"nothing was asked for"}); }
  /// Returns the answer that receive_wait() or another request has received, once.
  virtual std::optional<WaitAnswer> take_wait_answer() { return std::nullopt; }

  /// The number of received bytes that were late or did not belong to a reply, for all units that share the
  /// connection. Any thread may call it.
  virtual std::uint64_t discarded() const { return 0; }

  /// The certificates of the last connection; nullopt if it had no TLS. Any thread may call it.
  virtual std::optional<Certificates> certificates() const { return std::nullopt; }

  /// Discards bytes that came while no request was outstanding. An error means that the connection has ended
  /// or must not be used any more.
  virtual Result<> discard_unasked() {
    return fail(TransportFailure{"the device closed the connection, or sent an unexpected reply"});
  }

  enum class Woken { by_time, by_call, by_bytes };
  /// Returns when bytes have come, when the connection has ended, after wake(), or at `time`.
  virtual Woken wait_until(Time time) = 0;
  /// Ends the wait_until() in progress, or else the next one.
  virtual void wake() = 0;
};

}  // namespace coupler::host
