// SPDX-License-Identifier: Apache-2.0
#include "host/modbus/modbus_transport.hpp"

#include <modbus/modbus.h>
#include <sys/socket.h>

#include <cerrno>
#include <utility>

#include <fmt/format.h>

#include "host/modbus/exception_code.hpp"
#include "host/modbus/file_exchange.hpp"
#include "host/modbus/open_socket.hpp"
#include "host/modbus/raw_exchange.hpp"
#include "host/modbus/wait_for.hpp"

namespace coupler::driver {

ModbusTransport::ModbusTransport(const Connection& connection)
    : host_(connection.address),
      port_(connection.port),
      unit_(connection.unit),
      context_(modbus_new_tcp_pi(host_.c_str(), fmt::to_string(port_).c_str()), modbus_free) {
  modbus_set_byte_timeout(context_.get(), 0, 0);  // none: the response timeout holds for the whole reply
  modbus_set_error_recovery(context_.get(), MODBUS_ERROR_RECOVERY_NONE);
  select(connection.unit, connection.timeout);
}

ModbusTransport::~ModbusTransport() { ModbusTransport::close(); }

Result<> ModbusTransport::select(std::uint8_t unit, std::chrono::milliseconds timeout) {
  unit_ = unit;
  if (modbus_set_slave(context_.get(), unit_) != 0)
    return fail(NotConnected{fmt::format("unit {} is reserved; Modbus has units 0 to 247 and 255", unit_)});
  if (std::exchange(timeout_, timeout) == timeout) return {};
  const auto seconds = std::chrono::duration_cast<std::chrono::seconds>(timeout_);
  const auto rest = std::chrono::microseconds(timeout_ - seconds);
  modbus_set_response_timeout(context_.get(), static_cast<std::uint32_t>(seconds.count()),
                              static_cast<std::uint32_t>(rest.count()));
  return {};
}

Result<> ModbusTransport::connect() { return open(interrupted_); }

Result<> ModbusTransport::open(const Event& interrupt) {
  close();
  if (auto selected = select(unit_, timeout_); !selected) return selected;
  auto opened = open_socket(host_, port_, timeout_, interrupt);
  if (!opened) return tl::make_unexpected(opened.error());
  const std::lock_guard lock(socket_mutex_);
  if (interrupt.is_set()) return fail(NotConnected{"interrupted"});
  socket_ = opened->release();
  modbus_set_socket(context_.get(), socket_);
  return {};
}

void ModbusTransport::close() {
  const std::lock_guard lock(socket_mutex_);
  if (socket_ < 0) return;
  modbus_close(context_.get());
  socket_ = -1;
}

void ModbusTransport::interrupt() {
  interrupted_.set();
  hang_up();
}

void ModbusTransport::hang_up() {
  const std::lock_guard lock(socket_mutex_);
  if (socket_ >= 0) ::shutdown(socket_, SHUT_RDWR);
}

Result<> ModbusTransport::result(int returned, std::uint32_t expected) const {
  if (returned == static_cast<int>(expected)) return {};
  if (returned >= 0) return fail(BadFrame{fmt::format("{} values instead of {}", returned, expected)});
  const int error = errno;
  if (error > MODBUS_ENOBASE && error <= EMBXGTAR)
    return fail(ExceptionReply{static_cast<modbus::Exception>(error - MODBUS_ENOBASE)});
  switch (error) {
    case EMBBADEXC:  // a code above 0B, which libmodbus keeps to itself
      return fail(ExceptionReply{modbus::Exception{}});
    case ETIMEDOUT: return fail(Timeout{timeout_});
    case EMBBADCRC:
    case EMBBADDATA:
    case EMBBADSLAVE:
    case EMBMDATA:
    case EMBUNKEXC: return fail(BadFrame{modbus_strerror(error)});
    default: return fail(TransportFailure{modbus_strerror(error)});
  }
}

Result<> ModbusTransport::with_code(Result<> answer, Table table, modbus::Range range) {
  const ExceptionReply* exception = answer ? nullptr : exception_in(answer.error());
  if (exception == nullptr || exception->code != modbus::Exception{}) return answer;
  const auto code = ask_for_exception(socket_, next_header(), timeout_, table, range);
  if (!code) return tl::make_unexpected(code.error());
  return fail(ExceptionReply{*code});
}

Result<> ModbusTransport::read_bits(Table table, modbus::Range range, std::uint8_t* bits) {
  auto* read = table == Table::coils ? modbus_read_bits : modbus_read_input_bits;
  const int returned = read(context_.get(), range.start(), static_cast<int>(range.count()), bits);
  return with_code(result(returned, range.count()), table, range);
}

Result<> ModbusTransport::read_registers(Table table, modbus::Range range, std::uint16_t* registers) {
  auto* read = table == Table::holding_registers ? modbus_read_registers : modbus_read_input_registers;
  const int returned = read(context_.get(), range.start(), static_cast<int>(range.count()), registers);
  return with_code(result(returned, range.count()), table, range);
}

modbus::Frame ModbusTransport::next_header() {
  ++sent_.transaction;
  sent_.unit = unit_;
  return sent_;
}

Result<> ModbusTransport::read_file_record(std::uint16_t file, std::uint16_t record,
                                           Span<std::uint16_t> registers) {
  if (socket_ < 0) return fail(NotConnected{"not connected"});
  const modbus::FileRecord wanted{file, record, static_cast<std::uint16_t>(registers.size())};
  return exchange_file_record(socket_, next_header(), timeout_, wanted, registers);
}

Result<> ModbusTransport::send(const modbus::WriteRequest& request) {
  if (socket_ < 0) return fail(NotConnected{"not connected"});
  answer_by_ = Deadline(timeout_);
  return send_request(socket_, next_header(), request.pdu());
}

Result<> ModbusTransport::receive(const modbus::WriteRequest& request) {
  modbus::Framer framer;
  const auto reply = receive_reply(socket_, sent_, timeout_, answer_by_, framer);
  if (!reply) return tl::make_unexpected(reply.error());
  const auto checked = modbus::check_reply(request, *reply);
  if (checked) return {};
  if (checked.error().exception) return fail(ExceptionReply{*checked.error().exception});
  return fail(BadFrame{"not the answer to what was written"});
}

Transport::Woken ModbusTransport::wait_until(Time time) {
  return wait_for(wakeup_, interrupted_, socket_, time);
}

}  // namespace coupler::driver
