// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>

#include "coupler/credentials/validity.hpp"
#include "coupler/host/core/clock.hpp"
#include "coupler/host/core/error.hpp"
#include "coupler/host/core/wakeup.hpp"
#include "coupler/modbus/changes.hpp"

namespace coupler::host {

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

/// Carries PDUs to any unit of a device, of a gateway or of a serial line, one request after the other, by
/// Modbus/TCP or RTU. The turns of its users and the pauses of a map are Link's, which uses it.
///
/// The thread that has the turn calls its functions. Another one may be in wait_until() meanwhile, but not
/// while the channel is opened or closed. Any thread may call hang_up(), discarded() and certificates().
class Channel {
 public:
  virtual ~Channel() = default;

  /// Connects; gives up when `interrupt` is set. Closes an existing connection first, but not a serial port
  /// that still works.
  virtual Result<> open(const Event& interrupt) = 0;
  virtual void close() = 0;
  /// Ends the request in progress. open() is possible again.
  virtual void hang_up() = 0;
  /// Sets the unit of the next requests, and the time within which it must reply. An error, NotConnected,
  /// means that there can be no such unit.
  virtual Result<> select(std::uint8_t unit, std::chrono::milliseconds timeout) = 0;

  /// Sends a request. receive() must follow before any other.
  virtual Result<> send(modbus::Bytes pdu) = 0;
  /// Waits for the reply, at most until the timeout, and returns its PDU, which lives until the next call. It
  /// is from the selected unit; the caller must still check its content.
  virtual Result<modbus::Bytes> receive() = 0;
  /// Returns whether the last reply came, or was looked at, after the timeout.
  virtual bool is_late() const { return false; }
  /// Returns false if the last reply, though accepted, leaves it unknown where the next reply begins: the
  /// channel must be closed.
  virtual bool is_trusted() const { return true; }

  /// Returns true for RTU: a late reply can only be mistaken for another reply of the same unit, so the other
  /// units can be asked meanwhile.
  virtual bool is_bus() const { return false; }
  /// Returns whether a request to the selected unit would be sent without delay.
  virtual bool can_send() const { return true; }

  // A wait for changes (function code 65) may be outstanding while other requests are made: the device
  // answers it then at once, and before them.

  virtual bool can_wait() const { return false; }
  /// Sends a wait and does not wait for its answer. No other wait may be outstanding.
  virtual Result<> send_wait(const modbus::ChangesRequest& /*request*/) {
    return fail(NotConnected{"this connection cannot wait for changes"});
  }
  /// Receives the answer. Call it when bytes have come, or a timeout after the end of the wait. The rest of
  /// an answer that has begun is awaited for a timeout at most.
  virtual Result<> receive_wait() { return fail(NotConnected{"nothing was asked for"}); }
  /// Returns the answer that receive_wait() or receive() has received, once.
  virtual std::optional<WaitAnswer> take_wait_answer() { return std::nullopt; }

  /// Discards bytes that came while no request was outstanding. An error means that the connection has ended
  /// or must not be used any more.
  virtual Result<> discard_unasked() { return fail(TransportFailure{"the connection has ended"}); }
  /// Returns when bytes have come, when the connection has ended, after a call of `wakeup` or `interrupted`,
  /// or at `time`. On a bus no bytes end it.
  virtual Woken wait_until(Time time, Wakeup& wakeup, const Event& interrupted) {
    return wait_for(wakeup, &interrupted, -1, time);
  }

  /// The number of received bytes that were late or did not belong to a reply.
  virtual std::uint64_t discarded() const { return 0; }
  /// The certificates of the last connection; nullopt if it had no TLS.
  virtual std::optional<Certificates> certificates() const { return std::nullopt; }
};

}  // namespace coupler::host
