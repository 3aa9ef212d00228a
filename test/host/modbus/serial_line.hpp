// SPDX-License-Identifier: Apache-2.0
// A serial line without hardware, for tests: a pseudo terminal.
#pragma once

#include <fcntl.h>
#include <poll.h>
#include <stdlib.h>
#include <termios.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <functional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "coupler/host/core/wakeup.hpp"
#include "coupler/map/map.hpp"
#include "coupler/modbus/rtu_frame.hpp"

namespace coupler::host::test {

using Octets = std::vector<std::uint8_t>;

/// The frame of a PDU.
inline Octets rtu(std::uint8_t unit, const Octets& pdu) {
  Octets frame(modbus::max_rtu_size);
  frame.resize(modbus::put_rtu_frame(unit, pdu, frame.data()));
  return frame;
}

/// A port, and at the other end of the line units that answer requests: what `answer` returns goes back.
class SerialLine {
 public:
  using Answer = std::function<Octets(const Octets& request)>;

  explicit SerialLine(Answer answer)
      : answer_(std::move(answer)), end_(::posix_openpt(O_RDWR | O_NOCTTY | O_CLOEXEC)) {
    std::array<char, 64> name{};
    if (::grantpt(end_.get()) != 0 || ::unlockpt(end_.get()) != 0 ||
        ::ptsname_r(end_.get(), name.data(), name.size()) != 0)
      std::abort();
    device_ = name.data();
    // Otherwise what the units send before the port is open comes back to them.
    const Descriptor port(::open(name.data(), O_RDWR | O_NOCTTY | O_CLOEXEC));
    termios raw{};
    ::tcgetattr(port.get(), &raw);
    ::cfmakeraw(&raw);
    ::tcsetattr(port.get(), TCSANOW, &raw);
    thread_ = std::thread([this] { run(); });
  }
  ~SerialLine() { unplug(); }

  const std::string& device() const { return device_; }
  Connection connection(std::uint8_t unit, std::chrono::milliseconds timeout) const {
    Connection connection;
    connection.unit = unit;
    connection.timeout = timeout;
    connection.serial.device = device_;
    connection.serial.baud = 115200;
    connection.serial.parity = Serial::Parity::none;  // a pseudo terminal has none
    return connection;
  }
  void send(const Octets& bytes) const {
    if (::write(end_.get(), bytes.data(), bytes.size()) != static_cast<ssize_t>(bytes.size())) std::abort();
  }
  void unplug() {
    stop_.set();
    if (thread_.joinable()) thread_.join();
    end_ = Descriptor();
  }

 private:
  void run() {
    Octets request;
    while (!stop_.is_set()) {
      std::array<pollfd, 2> wanted{{{end_.get(), POLLIN, 0}, {stop_.fd(), POLLIN, 0}}};
      ::poll(wanted.data(), wanted.size(), -1);
      if (stop_.is_set()) return;
      std::uint8_t byte = 0;
      if (::read(end_.get(), &byte, 1) != 1) {  // nobody has the port open
        ::poll(&wanted[1], 1, 1);
        continue;
      }
      request.push_back(byte);
      if (request.size() < 8 || modbus::crc16(request) != 0) continue;
      const Octets reply = answer_(request);
      if (!reply.empty()) send(reply);
      request.clear();
    }
  }

  Answer answer_;
  Descriptor end_;
  std::string device_;
  Event stop_;
  std::thread thread_;
};

}  // namespace coupler::host::test
