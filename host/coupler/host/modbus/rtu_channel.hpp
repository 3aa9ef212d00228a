// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <optional>
#include <string>

#include "coupler/host/core/channel.hpp"
#include "coupler/host/modbus/serial_port.hpp"
#include "coupler/map/map.hpp"
#include "coupler/modbus/client.hpp"
#include "coupler/modbus/rtu_frame.hpp"

namespace coupler::host {

/// RTU frames over a serial port or, where a gateway does not translate them, over TCP (MSL 2.5.1).
///
/// There is no transaction number: the reply to a request is the next one of its unit and function that has
/// its length. After a Timeout that unit is not asked until one more timeout has passed, and what comes
/// meanwhile is discarded: its late reply could be taken for the reply to its next request.
///
/// A serial port stays open until it has failed: opening it again may restart what is connected.
///
/// Unit 0 addresses all units at once (MSL 2.1). Only writes can be sent to it, no unit answers them, and the
/// line then rests for a while.
///
/// The timeout begins when the last character of the request is out, and does not count those of the reply.
class RtuChannel : public Channel {
 public:
  explicit RtuChannel(const Connection& connection);
  RtuChannel(const RtuChannel&) = delete;
  RtuChannel& operator=(const RtuChannel&) = delete;

  Result<> open(const Event& interrupt) override;
  void close() override;
  void hang_up() override;
  Result<> select(std::uint8_t unit, std::chrono::milliseconds timeout) override;
  Result<> send(modbus::Bytes pdu) override;
  Result<modbus::Bytes> receive() override;
  bool is_late() const override { return is_late_; }
  bool is_bus() const override { return true; }
  bool can_send() const override;
  std::uint64_t discarded() const override { return discarded_; }

 private:
  Woken wait(int fd, Time until);
  Result<> pause(Time until);
  Result<> look_for_echo(std::uint16_t address, Table table);
  Result<> send_frame(modbus::Bytes pdu);
  Result<> await_line();
  Result<> discard();
  tl::unexpected<Error> port_has_gone() const;
  Result<> put(modbus::Bytes frame);
  Result<Span<const std::uint8_t>> get(Span<std::uint8_t> room);
  Duration time_of(std::size_t characters) const;

  std::string host_;
  std::uint16_t port_;
  std::string device_;
  Serial line_;  ///< of `device_`; none: RTU over TCP
  std::uint8_t unit_;
  std::chrono::milliseconds timeout_;
  std::optional<SerialPort> serial_;
  Descriptor socket_;
  int fd_ = -1;                          ///< of one of them
  bool has_failed_ = false;              ///< since it was opened
  std::atomic<bool> is_hung_up_{false};  ///< the request in progress is
  Wakeup hung_up_;
  modbus::RtuFramer framer_;
  bool is_late_ = false;   ///< the last reply came, or was looked at, after its time
  bool damaged_ = false;   ///< something has come since the request, and is no reply
  Time last_character_{};  ///< on the line, of either side
  Time answer_by_{};
  Time busy_until_{};           ///< the reply to a request that was given up is awaited until then
  std::uint8_t late_unit_ = 0;  ///< did not reply in time, and may still
  Time late_until_{};
  std::atomic<std::uint64_t> discarded_{0};
};

}  // namespace coupler::host
