// SPDX-License-Identifier: Apache-2.0
// The bare client: as little as can read registers over a serial line, again and again. It waits for the
// reply and for the silence, and looks at nothing.
//   coupler_bench_serial_bare PORT REGISTERS SILENCE_NS
#include <fcntl.h>
#include <unistd.h>

#include <array>

#include "coupler/modbus/rtu_frame.hpp"
#include "test/bench/serial/terminal.hpp"

int main(int argc, char** argv) {
  using namespace coupler;
  if (argc != 4) return 2;
  const int port = ::open(argv[1], O_RDWR | O_NOCTTY | O_CLOEXEC);
  if (port < 0) bench::give_up(argv[1]);
  bench::make_raw(port);
  const auto count = static_cast<std::uint8_t>(std::atoi(argv[2]));
  const std::int64_t silence = std::atoll(argv[3]);
  std::array<std::uint8_t, modbus::max_rtu_size> request{};
  const std::array<std::uint8_t, 5> pdu{4, 0, 0, 0, count};
  const auto size = static_cast<ssize_t>(modbus::put_rtu_frame(1, pdu, request.data()));
  std::array<std::uint8_t, modbus::max_rtu_size> reply{};
  for (;;) {
    if (::write(port, request.data(), static_cast<std::size_t>(size)) != size) return 1;
    for (ssize_t left = 5 + 2 * count; left > 0;) {
      const auto got = ::read(port, reply.data(), static_cast<std::size_t>(left));
      if (got <= 0) return 0;  // the unit has gone
      left -= got;
    }
    bench::sleep_until(bench::now() + silence);
  }
}
