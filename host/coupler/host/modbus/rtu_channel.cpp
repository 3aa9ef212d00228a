// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/modbus/rtu_channel.hpp"

#include <netinet/in.h>
#include <netinet/tcp.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <utility>

#include <fmt/format.h>

#include "coupler/base/descriptor.hpp"
#include "coupler/host/modbus/open_socket.hpp"
#include "coupler/map/functions.hpp"

namespace coupler::host {
namespace {

/// After a broadcast, for the units to do what it says: 100 to 200 ms (MSL 2.4.1).
constexpr std::chrono::milliseconds turnaround{100};

/// The line rests this long after hang_up(), since the reply may still come. It does not rest for the whole
/// timeout of a dead unit: at shutdown the other units' safe values could not be written meanwhile.
constexpr std::chrono::milliseconds rest_after_hang_up{100};

/// A line on which something babbles is asked all the same.
constexpr int most_discarded_pieces = 64;

Time now() { return std::chrono::steady_clock::now(); }

bool writes_several(modbus::Bytes pdu) {
  const auto function = static_cast<modbus::Function>(pdu[0]);
  return function == modbus::Function::write_multiple_coils ||
         function == modbus::Function::write_multiple_registers;
}

bool is_write(modbus::Bytes pdu) {
  const auto function = static_cast<modbus::Function>(pdu[0]);
  return writes_several(pdu) || function == modbus::Function::write_single_coil ||
         function == modbus::Function::write_single_register ||
         function == modbus::Function::mask_write_register;
}

/// Returns what a unit repeats of a write (MAP 6.5, 6.6, 6.11, 6.12, 6.16).
modbus::Bytes confirmation(modbus::Bytes pdu) { return writes_several(pdu) ? pdu.first(5) : pdu; }

/// Lets TCP end the connection to a gateway that has vanished: a Timeout does not close it, so it would stay
/// open.
void notice_loss(int socket, std::chrono::milliseconds timeout) {
  const auto longest = static_cast<unsigned>(std::max(timeout, std::chrono::milliseconds(3000)).count());
  ::setsockopt(socket, IPPROTO_TCP, TCP_USER_TIMEOUT, &longest, sizeof longest);
}

}  // namespace

RtuChannel::RtuChannel(const Connection& connection)
    : host_(connection.address),
      port_(connection.port),
      device_(connection.serial.device),
      line_(connection.serial),
      unit_(connection.unit),
      timeout_(connection.timeout) {
  line_.device = device_;
}

Duration RtuChannel::time_of(std::size_t characters) const {
  return line_.present() ? time_of_characters(line_, characters) : Duration::zero();
}

Result<> RtuChannel::select(std::uint8_t unit, std::chrono::milliseconds timeout) {
  hung_up_.clear();  // a call that was meant for the unit before
  is_hung_up_ = false;
  if (unit != rtu_broadcast && !is_rtu_unit(unit))
    return fail(NotConnected{fmt::format("unit {} cannot be asked; RTU has units 1 to 247", unit)});
  unit_ = unit;
  timeout_ = timeout;
  return {};
}

Result<> RtuChannel::open(const Event& interrupt) {
  close();
  if (auto selected = select(unit_, timeout_); !selected) return selected;
  if (fd_ >= 0) return {};
  if (line_.present()) {
    auto opened = SerialPort::open(line_);
    if (!opened) return tl::make_unexpected(opened.error());
    serial_ = std::move(*opened);
    fd_ = serial_->fd();
  } else {
    auto opened = open_socket(host_, port_, timeout_, interrupt);
    if (!opened) return tl::make_unexpected(opened.error());
    socket_ = std::move(*opened);
    fd_ = socket_.get();
    notice_loss(fd_, timeout_);
  }
  if (interrupt.is_set()) return fail(NotConnected{"interrupted"});
  has_failed_ = false;
  framer_.reset();
  last_character_ = now();
  return {};
}

bool RtuChannel::can_send() const {
  const Time free = late_unit_ == unit_ ? std::max(busy_until_, late_until_) : busy_until_;
  return framer_.has_echo() && now() >= free;
}

void RtuChannel::hang_up() {
  is_hung_up_ = true;
  hung_up_.call();
}

void RtuChannel::close() {
  if (serial_ && !has_failed_) return;
  serial_.reset();
  socket_ = Descriptor();
  fd_ = -1;
}

/// Finds out whether the line has an echo. A read tells, even one that is refused or not answered.
Result<> RtuChannel::look_for_echo(std::uint16_t address, Table table) {
  const modbus::ReadRequest request(read_function(table), modbus::Range::of(address, 1));
  if (auto sent = send_frame(request.pdu()); !sent) return sent;
  const auto reply = receive();
  if (reply || std::holds_alternative<Timeout>(reply.error()) ||
      std::holds_alternative<BadFrame>(reply.error()))
    return {};
  return tl::make_unexpected(reply.error());
}

Result<> RtuChannel::send(modbus::Bytes pdu) {
  if (unit_ == rtu_broadcast && !is_write(pdu))
    return fail(NotConnected{"unit 0 is a broadcast, which nobody answers; read from units 1 to 247"});
  if (unit_ != rtu_broadcast && framer_.needs_a_read_before(pdu)) {
    const bool is_coil = pdu[0] == static_cast<std::uint8_t>(modbus::Function::write_single_coil);
    const Table table = is_coil ? Table::coils : Table::holding_registers;
    if (auto looked = look_for_echo(modbus::get_u16(&pdu[1]), table); !looked) return looked;
  }
  return send_frame(pdu);
}

Result<> RtuChannel::send_frame(modbus::Bytes pdu) {
  if (fd_ < 0) return fail(NotConnected{"not connected"});
  if (auto free = await_line(); !free) return free;
  framer_.expect(unit_, pdu);
  damaged_ = false;
  const modbus::Bytes frame = framer_.request();
  last_character_ = now() + time_of(frame.size());
  answer_by_ = last_character_ + timeout_ + time_of(modbus::longest_reply(pdu) + modbus::rtu_overhead);
  busy_until_ = unit_ == rtu_broadcast ? last_character_ + turnaround : answer_by_;
  return put(frame);
}

Result<modbus::Bytes> RtuChannel::receive() {
  if (unit_ == rtu_broadcast) return confirmation(framer_.request_pdu());
  for (;;) {
    switch (wait(fd_, answer_by_)) {
      case Woken::by_call:
        busy_until_ = std::min(busy_until_, now() + rest_after_hang_up);
        late_unit_ = unit_;
        late_until_ = answer_by_;
        return fail(NotConnected{"interrupted"});
      case Woken::by_time:
        framer_.silent();
        discarded_ += framer_.skipped();
        late_unit_ = unit_;
        late_until_ = now() + timeout_;
        if (!damaged_ || framer_.holds_another_frame()) return fail(Timeout{timeout_});
        return fail(
            BadFrame{fmt::format("what has come is no reply of unit {}; check baud rate and parity, and "
                                 "that no two units have the same number",
                                 unit_)});
      case Woken::by_bytes: break;
    }
    const auto got = get(framer_.room());
    if (!got) return tl::make_unexpected(got.error());
    framer_.filled(got->size());
    switch (framer_.next()) {
      case modbus::RtuFramer::Outcome::reply:
        discarded_ += framer_.skipped();
        busy_until_ = {};
        is_late_ = now() > answer_by_;
        return framer_.pdu();
      case modbus::RtuFramer::Outcome::damaged: damaged_ = true; break;
      case modbus::RtuFramer::Outcome::nothing: break;
    }
  }
}

/// A call that comes together with bytes counts, too. A signal ends no wait.
Woken RtuChannel::wait(int fd, Time until) {
  for (;;) {
    const Woken woken = wait_for(hung_up_, nullptr, fd, until);
    if (is_hung_up_) return Woken::by_call;
    if (woken == Woken::by_bytes || now() >= until) return woken;
  }
}

Result<> RtuChannel::pause(Time until) {
  if (wait(-1, until) == Woken::by_call) return fail(NotConnected{"interrupted"});
  return {};
}

/// Until nobody's reply is expected on it, and it has been silent between two frames (MSL 2.5.1.1).
Result<> RtuChannel::await_line() {
  if (auto paused = pause(busy_until_); !paused) return paused;
  if (late_unit_ == unit_) {
    if (auto paused = pause(late_until_); !paused) return paused;
    late_unit_ = 0;
  }
  for (int piece = 0; piece < most_discarded_pieces; ++piece) {
    if (auto discarded = discard(); !discarded) return discarded;
    if (!line_.present()) break;
    if (auto paused = pause(last_character_ + silence_between_frames(line_)); !paused) return paused;
    if (!is_readable(fd_)) break;  // otherwise it was not silent: the reply has come twice, for instance
  }
  return {};
}

Result<> RtuChannel::discard() {
  std::array<std::uint8_t, modbus::max_rtu_size> late{};
  for (int piece = 0; piece < most_discarded_pieces && is_readable(fd_); ++piece) {
    const auto got = get(late);
    if (!got) return tl::make_unexpected(got.error());
    discarded_ += got->size();
  }
  return {};
}

tl::unexpected<Error> RtuChannel::port_has_gone() const {
  return fail(TransportFailure{fmt::format("the port {} has gone; is its adapter plugged in?", device_)});
}

Result<> RtuChannel::put(modbus::Bytes frame) {
  const auto sent = line_.present() ? ::write(fd_, frame.data(), frame.size())
                                    : ::send(fd_, frame.data(), frame.size(), MSG_NOSIGNAL | MSG_DONTWAIT);
  if (sent == static_cast<ssize_t>(frame.size())) return {};
  has_failed_ = true;
  if (sent < 0 && line_.present() && (errno == EIO || errno == ENODEV || errno == ENXIO))
    return port_has_gone();
  return fail(TransportFailure{sent < 0 ? std::strerror(errno) : "only a part of the request could be sent"});
}

/// There is something to read, or the end.
Result<Span<const std::uint8_t>> RtuChannel::get(Span<std::uint8_t> room) {
  const auto got = ::read(fd_, room.data(), room.size());
  if (got > 0) {
    last_character_ = now();
    return Span<const std::uint8_t>(room.data(), static_cast<std::size_t>(got));
  }
  if (got < 0 && would_block()) return Span<const std::uint8_t>();
  has_failed_ = true;
  if (!line_.present())
    return fail(TransportFailure{got == 0 ? "the device closed the connection" : std::strerror(errno)});
  return port_has_gone();
}

}  // namespace coupler::host
