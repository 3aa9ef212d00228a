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

/// Who goes first where units share a connection: writes before reads, in turn
/// (coupler/host/modbus/turns.hpp).
enum class Rank {
  read,
  write,  ///< also the read before a write, and the one that verifies it
  safe    ///< before all others, until another rank is set
};

/// What came of a wait for changes, and when.
struct WaitAnswer {
  Result<modbus::ChangesReply> reply;  ///< an error is an exception
  Time sent{};
  Time received{};
};

/// What one side of a TLS connection shows of itself.
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

/// The port to one unit of a Modbus device. One request is in flight at a time; its reply is awaited for the
/// device's timeout at most. It belongs to one thread; another may call reserve(), give_back() and send_pdu()
/// while it knows, by a lock of its own, that the owner does nothing but wait_until(). interrupt() and wake()
/// may come from anywhere.
class Transport {
 public:
  virtual ~Transport() = default;

  virtual Result<> connect() = 0;
  virtual void close() = 0;
  /// Ends the call in progress; it and every later one fail at once.
  virtual void interrupt() = 0;

  /// Sends a PDU and waits for the reply. Returns its PDU, valid until the next request: of the function that
  /// was asked for, and as modbus::check_reply() wants it. A read's reply that came too late is a Timeout.
  virtual Result<modbus::Bytes> exchange(modbus::Bytes pdu) = 0;
  /// The first half of exchange(): does not wait for the reply. receive_pdu() must follow before any other
  /// request.
  virtual Result<> send_pdu(modbus::Bytes pdu) = 0;
  /// The second half: the reply to what was sent, at the latest a timeout after that.
  virtual Result<modbus::Bytes> receive_pdu() = 0;

  // What the PDUs mean.

  /// FC 1 or 2: `range.count()` (at most 2000) elements of 0 or 1.
  Result<> read_bits(Table table, modbus::Range range, std::uint8_t* bits);
  /// FC 3 or 4: `range.count()` (at most 125) registers.
  Result<> read_registers(Table table, modbus::Range range, std::uint16_t* registers);
  /// read_bits() or read_registers(), bits as 0 or 1.
  Result<> read(Table table, modbus::Range range, std::uint16_t* values);
  /// FC 20 with one group: fills `registers` (1 … 121) from a file.
  Result<> read_file_record(std::uint16_t file, std::uint16_t record, Span<std::uint16_t> registers);
  /// send_pdu() of a write. receive() must follow.
  Result<> send(const modbus::WriteRequest& request) { return send_pdu(request.pdu()); }
  /// Its confirmation.
  Result<> receive();
  /// FC 66. Where units share a connection, none of them can.
  Result<modbus::ScheduleReply> schedule(const modbus::ScheduleRequest& request);

  // For units that share a connection, and take turns. A transport in front of another one hands these on.

  /// Sets the rank of the reads that follow, and of the writes if it is Rank::safe. Otherwise writes are
  /// Rank::write.
  virtual void rank(Rank /*rank*/) {}
  enum class Turn { none, read, write };
  /// Waits until a read, or with `write_waits` a write, would be sent at once: whichever comes first. That
  /// request or another call must follow. Turn::none after wake(), or at `until`: something else may come
  /// before a read.
  virtual Turn await_turn(Time /*until*/, bool /*write_waits*/ = false) { return Turn::read; }
  /// Waits until a send_pdu() would wait for nobody else's request, or would fail; or until `ends()` is true,
  /// which is called at first and after each wake(). A request or give_back() must follow.
  virtual void await_turn_to_write(const std::function<bool()>& /*ends*/) {}
  /// Whether a send_pdu() made now would wait for nobody else's request. If true, send_pdu() or give_back()
  /// must follow.
  virtual bool reserve() { return true; }
  /// No request follows: the turn, if it was this unit's, is for others.
  virtual void give_back() {}

  // A wait for changes (function code 65) may be outstanding while other requests are made: the device
  // answers it then at once, and before them.

  /// Where units share a connection, none of them can.
  virtual bool can_wait() const { return false; }
  /// Sends and does not wait for the answer. There must be none outstanding.
  virtual Result<> send_wait(const modbus::ChangesRequest& /*request*/) {
    return fail(NotConnected{"this connection cannot wait for changes"});
  }
  /// To be called when bytes have come, or a timeout after the wait is over. An answer that has begun is
  /// awaited for a timeout at most.
  virtual Result<> receive_wait() { return fail(NotConnected{"nothing was asked for"}); }
  /// The answer that receive_wait() or another request has received: once.
  virtual std::optional<WaitAnswer> take_wait_answer() { return std::nullopt; }

  /// Bytes that came after their time, or were no reply: of all units that share the connection. From
  /// any thread.
  virtual std::uint64_t discarded() const { return 0; }

  /// Of the last connection that was made; nullopt: none with TLS. From any thread.
  virtual std::optional<Certificates> certificates() const { return std::nullopt; }

  /// wait_until() returned for bytes, and nothing was asked: throws them away where that can be done. An
  /// error means that the connection has ended, or can no longer be used.
  virtual Result<> discard_unasked() {
    return fail(TransportFailure{"the device closed the connection, or sent an unexpected reply"});
  }

  enum class Woken { by_time, by_call, by_bytes };
  /// Returns when bytes have come (or the connection has ended), after wake(), or at `time`.
  virtual Woken wait_until(Time time) = 0;
  /// Ends the wait in progress, or the next one.
  virtual void wake() = 0;
};

}  // namespace coupler::host
