// SPDX-License-Identifier: Apache-2.0
// A unit on a serial line without hardware: the other end of a pseudo terminal. Characters of 10 bits (8N1)
// take their time there, and so does the unit.
//   coupler_bench_serial_unit BAUD REPLY_US SECONDS
// Has the input registers 0 to 124, and answers everything else with an exception. Prints the name of the
// port; then, SECONDS after the first reads, a line for each of them since: when the request came, how many
// characters it and the reply had, when the last one was handed over. Times are ns of CLOCK_MONOTONIC.
#include <fcntl.h>
#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <optional>
#include <vector>

#include "coupler/modbus/pdu.hpp"
#include "coupler/modbus/rtu_frame.hpp"
#include "test/bench/serial/terminal.hpp"

namespace {

using namespace coupler;
using bench::now;

using Octets = std::vector<std::uint8_t>;

constexpr std::int64_t bits_per_character = 10;
constexpr std::size_t request_size = 8;      ///< of all requests to read
constexpr std::int64_t burst = 500'000;      ///< ns: what has come meanwhile is handed over at once
constexpr int patience = 30'000;             ///< ms without a request
constexpr std::size_t reads_before = 10;     ///< until both sides are warm
constexpr std::uint8_t input_registers = 4;  ///< function code
constexpr std::uint8_t illegal_address = 2;  ///< exception

struct Read {
  std::int64_t came;
  std::size_t request;
  std::size_t reply;
  std::int64_t went;
};

int open_line() {
  const int line = ::posix_openpt(O_RDWR | O_NOCTTY | O_CLOEXEC);
  std::array<char, 64> name{};
  if (line < 0 || ::grantpt(line) != 0 || ::unlockpt(line) != 0 ||
      ::ptsname_r(line, name.data(), name.size()) != 0)
    bench::give_up("posix_openpt");
  const int held = ::open(name.data(), O_RDWR | O_NOCTTY | O_CLOEXEC);  // stays: nobody sees it hung up
  if (held < 0) bench::give_up(name.data());
  bench::make_raw(held);
  std::puts(name.data());
  std::fflush(stdout);
  return line;
}

class Unit {
 public:
  Unit(std::int64_t baud, std::int64_t reply_time)
      : line_(open_line()), baud_(baud), reply_time_(reply_time) {}

  /// nullopt: it was no read of the registers.
  std::optional<Read> serve() {
    const std::int64_t came = receive();
    if (modbus::crc16(request_) != 0) {
      std::fputs("coupler_bench_serial_unit: a request is damaged\n", stderr);
      std::exit(1);
    }
    const std::size_t first = modbus::get_u16(&request_[2]);
    const std::size_t count = modbus::get_u16(&request_[4]);
    const bool is_read =
        request_[1] == input_registers && count >= 1 && first + count <= modbus::max_read_registers;
    const Octets reply = frame(is_read ? values(first, count) : Octets{exception(), illegal_address});
    const std::int64_t went = send(reply, came + characters(request_.size()) + reply_time_);
    if (!is_read) return std::nullopt;
    return Read{came, request_.size(), reply.size(), went};
  }

 private:
  std::int64_t characters(std::size_t count) const {
    return static_cast<std::int64_t>(count) * bits_per_character * bench::second / baud_;
  }
  std::uint8_t exception() const { return static_cast<std::uint8_t>(request_[1] | modbus::exception_bit); }

  /// When its first characters came.
  std::int64_t receive() {
    std::int64_t came = 0;
    for (std::size_t size = 0; size < request_size;) {
      pollfd wanted{line_, POLLIN, 0};
      if (::poll(&wanted, 1, patience) <= 0) bench::give_up("no request");
      if (size == 0) came = now();
      const auto got = ::read(line_, &request_[size], request_size - size);
      if (got <= 0) bench::give_up("read");
      size += static_cast<std::size_t>(got);
    }
    return came;
  }

  /// Others each time.
  Octets values(std::size_t first, std::size_t count) {
    ++served_;
    Octets pdu{input_registers, static_cast<std::uint8_t>(2 * count)};
    for (std::size_t i = first; i < first + count; ++i) {
      const auto value = static_cast<std::uint16_t>(served_ + i);
      pdu.push_back(static_cast<std::uint8_t>(value >> 8));
      pdu.push_back(static_cast<std::uint8_t>(value));
    }
    return pdu;
  }

  Octets frame(const Octets& pdu) const {
    Octets whole(modbus::max_rtu_size);
    whole.resize(modbus::put_rtu_frame(request_[0], pdu, whole.data()));
    return whole;
  }

  /// No character is there before the line can have carried it. Returns when the last one was handed over.
  std::int64_t send(const Octets& reply, std::int64_t begin) const {
    const auto at_once = std::max<std::size_t>(burst * baud_ / (bits_per_character * bench::second), 1);
    std::int64_t time = 0;
    for (std::size_t sent = 0; sent < reply.size();) {
      const std::size_t size = std::min(at_once, reply.size() - sent);
      bench::sleep_until(begin + characters(sent + size));
      time = now();
      if (::write(line_, &reply[sent], size) != static_cast<ssize_t>(size)) bench::give_up("write");
      sent += size;
    }
    return time;
  }

  int line_;
  std::int64_t baud_;
  std::int64_t reply_time_;
  std::array<std::uint8_t, request_size> request_{};
  std::size_t served_ = 0;
};

}  // namespace

int main(int argc, char** argv) {
  if (argc != 4) return 2;
  Unit unit(std::atoll(argv[1]), 1000 * std::atoll(argv[2]));
  const auto length = static_cast<std::int64_t>(std::atof(argv[3]) * bench::second);
  for (std::size_t i = 0; i < reads_before;)
    if (unit.serve()) ++i;
  std::vector<Read> reads;
  for (const std::int64_t end = now() + length; now() < end || reads.size() < 3;)
    if (const auto read = unit.serve()) reads.push_back(*read);
  for (const Read& read : reads)
    std::printf("%lld %zu %zu %lld\n", static_cast<long long>(read.came), read.request, read.reply,
                static_cast<long long>(read.went));
  return 0;
}
