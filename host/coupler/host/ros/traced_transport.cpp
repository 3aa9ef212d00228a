// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/ros/traced_transport.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace coupler::host {
namespace {

Time now() { return std::chrono::steady_clock::now(); }

std::string describe_read(Table table, modbus::Range range) {
  return fmt::format("read {} {} to {}", to_string(table), range.start(), range.last());
}

}  // namespace

template <class Describe>
Result<> TracedTransport::told(Result<> result, Time begun, Describe describe) {
  if (!log_.shows_debug()) return result;
  const std::chrono::duration<double, std::milli> took = now() - begun;
  log_.log_debug(fmt::format("{}: {}: {} after {:.3f} ms", name_, describe(),
                             result ? std::string("ok") : to_string(result.error()), took.count()));
  return result;
}

Result<> TracedTransport::connect() {
  const Time begun = now();
  return told(transport_->connect(), begun, [] { return "connect"; });
}

Result<> TracedTransport::read_bits(Table table, modbus::Range range, std::uint8_t* bits) {
  asked_ = now();
  return told(transport_->read_bits(table, range, bits), asked_, [&] { return describe_read(table, range); });
}

Result<> TracedTransport::read_registers(Table table, modbus::Range range, std::uint16_t* registers) {
  asked_ = now();
  return told(transport_->read_registers(table, range, registers), asked_,
              [&] { return describe_read(table, range); });
}

Result<> TracedTransport::read_file_record(std::uint16_t file, std::uint16_t record,
                                           Span<std::uint16_t> registers) {
  asked_ = now();
  return told(transport_->read_file_record(file, record, registers), asked_, [&] {
    return fmt::format("read file {} from {}, {} registers", file, record, registers.size());
  });
}

Result<> TracedTransport::send(const modbus::WriteRequest& request) {
  sent_ = now();
  return transport_->send(request);
}

Result<> TracedTransport::receive(const modbus::WriteRequest& request) {
  return told(transport_->receive(request), sent_, [&] {
    return fmt::format("write by FC {} at {}: {:02x}", static_cast<int>(request.function()),
                       request.address(), fmt::join(request.pdu().begin() + 3, request.pdu().end(), " "));
  });
}

}  // namespace coupler::host
