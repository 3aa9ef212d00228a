// SPDX-License-Identifier: Apache-2.0
#include "host/modbus/modbus_transport.hpp"

#include <modbus/modbus.h>
#include <sys/socket.h>

#include <cerrno>

#include <fmt/format.h>

#include "host/modbus/file_exchange.hpp"
#include "host/modbus/open_socket.hpp"

namespace coupler::driver {

ModbusTransport::ModbusTransport(const Connection& connection)
    : host_(connection.address),
      port_(connection.port),
      unit_(connection.unit),
      timeout_(connection.timeout),
      context_(modbus_new_tcp_pi(host_.c_str(), fmt::to_string(port_).c_str()), modbus_free) {
  const auto seconds = std::chrono::duration_cast<std::chrono::seconds>(timeout_);
  const auto rest = std::chrono::microseconds(timeout_ - seconds);
  modbus_set_response_timeout(context_.get(), static_cast<std::uint32_t>(seconds.count()),
                              static_cast<std::uint32_t>(rest.count()));
  modbus_set_byte_timeout(context_.get(), 0, 0);  // none: the response timeout holds for the whole reply
  modbus_set_error_recovery(context_.get(), MODBUS_ERROR_RECOVERY_NONE);
}

ModbusTransport::~ModbusTransport() { ModbusTransport::close(); }

Result<> ModbusTransport::connect() {
  close();
  if (modbus_set_slave(context_.get(), unit_) != 0)
    return fail(NotConnected{fmt::format("unit {} is reserved; Modbus has units 0 to 247 and 255", unit_)});
  auto opened = open_socket(host_, port_, timeout_, interrupted_);
  if (!opened) return tl::make_unexpected(opened.error());
  const std::lock_guard lock(socket_mutex_);
  if (interrupted_.is_set()) return fail(NotConnected{"interrupted"});
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

Result<> ModbusTransport::read_bits(Table table, modbus::Range range, std::uint8_t* bits) {
  auto* read = table == Table::coils ? modbus_read_bits : modbus_read_input_bits;
  return result(read(context_.get(), range.start(), static_cast<int>(range.count()), bits), range.count());
}

Result<> ModbusTransport::read_registers(Table table, modbus::Range range, std::uint16_t* registers) {
  auto* read = table == Table::holding_registers ? modbus_read_registers : modbus_read_input_registers;
  return result(read(context_.get(), range.start(), static_cast<int>(range.count()), registers),
                range.count());
}

Result<> ModbusTransport::write_coil(std::uint16_t address, bool on) {
  return result(modbus_write_bit(context_.get(), address, on ? 1 : 0), 1);
}

Result<> ModbusTransport::write_register(std::uint16_t address, std::uint16_t value) {
  return result(modbus_write_register(context_.get(), address, value), 1);
}

Result<> ModbusTransport::write_coils(std::uint16_t address, Span<const std::uint8_t> bits) {
  const auto count = static_cast<std::uint32_t>(bits.size());
  return result(modbus_write_bits(context_.get(), address, static_cast<int>(count), bits.data()), count);
}

Result<> ModbusTransport::write_registers(std::uint16_t address, Span<const std::uint16_t> registers) {
  const auto count = static_cast<std::uint32_t>(registers.size());
  return result(modbus_write_registers(context_.get(), address, static_cast<int>(count), registers.data()),
                count);
}

Result<> ModbusTransport::mask_write(std::uint16_t address, std::uint16_t and_mask, std::uint16_t or_mask) {
  return result(modbus_mask_write_register(context_.get(), address, and_mask, or_mask), 1);
}

Result<> ModbusTransport::read_file_record(std::uint16_t file, std::uint16_t record,
                                           Span<std::uint16_t> registers) {
  if (socket_ < 0) return fail(NotConnected{"not connected"});
  const modbus::FileRecord wanted{file, record, static_cast<std::uint16_t>(registers.size())};
  return exchange_file_record(socket_, unit_, timeout_, wanted, registers);
}

}  // namespace coupler::driver
