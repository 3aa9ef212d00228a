// SPDX-License-Identifier: Apache-2.0
// A serial line, and how long characters take on it ("MODBUS over Serial Line Specification and
// Implementation Guide V1.02", MSL).
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "coupler/base/enumeration.hpp"

namespace coupler {

/// How frames are told apart, and what is in front of a PDU.
enum class Framing : std::uint8_t {
  tcp,  ///< Modbus/TCP
  rtu   ///< unit, PDU and CRC, over a serial line or, where a gateway does not translate, over TCP
};
constexpr Enumeration<Framing, 2> enumeration(Framing) {
  return {"Framing", {{Framing::tcp, "tcp"}, {Framing::rtu, "rtu"}}};
}

/// The serial port of the host. Defaults: MSL 2.5.1.
struct Serial {
  enum class Parity : std::uint8_t { none, even, odd };

  std::string_view device;     ///< as "/dev/ttyUSB0"; empty: none
  std::uint32_t baud = 19200;  ///< bits a second
  Parity parity = Parity::even;
  std::uint16_t stop_bits = 1;
  bool rs485 = false;  ///< the driver of the port switches the direction (Linux: TIOCSRS485)

  constexpr bool present() const { return !device.empty(); }
  friend constexpr bool operator==(const Serial& a, const Serial& b) {
    return a.device == b.device && a.baud == b.baud && a.parity == b.parity && a.stop_bits == b.stop_bits &&
           a.rs485 == b.rs485;
  }
  friend constexpr bool operator!=(const Serial& a, const Serial& b) { return !(a == b); }
};
constexpr Enumeration<Serial::Parity, 3> enumeration(Serial::Parity) {
  using Parity = Serial::Parity;
  return {"Serial::Parity", {{Parity::even, "even"}, {Parity::odd, "odd"}, {Parity::none, "none"}}};
}

/// Those that libmodbus can set; it takes 9600 for any other.
constexpr std::uint32_t serial_rates[] = {110,    300,    600,     1200,    2400,   4800,   9600,
                                          19200,  38400,  57600,   115200,  230400, 460800, 500000,
                                          576000, 921600, 1000000, 1152000, 1500000};
constexpr bool is_serial_rate(std::uint32_t baud) {
  for (const std::uint32_t rate : serial_rates)
    if (rate == baud) return true;
  return false;
}

/// How long a device may take if nobody says it. With RTU the time of the characters comes on top.
constexpr std::chrono::milliseconds usual_timeout(bool is_rtu) {
  return std::chrono::milliseconds(is_rtu ? 500 : 3000);
}

/// Those above 247 are reserved (MSL 2.2).
constexpr std::uint8_t rtu_broadcast = 0;
constexpr bool is_rtu_unit(std::uint64_t unit) { return unit >= 1 && unit <= 247; }

/// "N", "E" or "O", as in 8N1.
constexpr char parity_letter(Serial::Parity parity) { return "NEO"[static_cast<int>(parity)]; }

/// Start bit, 8 data bits, parity, stop bits.
constexpr unsigned bits_per_character(const Serial& line) {
  return 9U + (line.parity == Serial::Parity::none ? 0U : 1U) + line.stop_bits;
}

constexpr std::chrono::nanoseconds time_of_characters(const Serial& line, std::size_t count) {
  return std::chrono::nanoseconds(std::uint64_t{1'000'000'000} * bits_per_character(line) * count /
                                  line.baud);
}

/// The pause between two frames (MSL 2.5.1.1): 3.5 characters, 1.75 ms above 19200 bits a second.
constexpr std::chrono::nanoseconds silence_between_frames(const Serial& line) {
  if (line.baud > 19200) return std::chrono::microseconds(1750);
  return time_of_characters(line, 7) / 2;
}

}  // namespace coupler
