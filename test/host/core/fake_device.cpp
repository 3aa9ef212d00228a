// SPDX-License-Identifier: Apache-2.0
#include "test/host/core/fake_device.hpp"

#include <algorithm>
#include <array>

#include <fmt/format.h>

#include "coupler/map/identity.hpp"
#include "coupler/modbus/server.hpp"

namespace coupler::host::test {
namespace {

/// "write coil 5", "write registers 7+4", "write mask 3"
std::string describe(const modbus::WriteRequest& request) {
  const auto parsed = modbus::parse_request(request.pdu());
  switch (request.function()) {
    case modbus::Function::write_single_coil: return fmt::format("write coil {}", request.address());
    case modbus::Function::write_single_register: return fmt::format("write register {}", request.address());
    case modbus::Function::mask_write_register: return fmt::format("write mask {}", request.address());
    case modbus::Function::write_multiple_coils:
      return fmt::format("write coils {}+{}", request.address(),
                         std::get<modbus::WriteBits>(*parsed).range.count());
    default:
      return fmt::format("write registers {}+{}", request.address(),
                         std::get<modbus::WriteRegisters>(*parsed).range.count());
  }
}

}  // namespace

FakeDevice::FakeDevice() = default;
FakeDevice::~FakeDevice() = default;

void FakeDevice::serve(const Map& map) {
  file = map.text;
  std::array<std::uint16_t, identity::head_size> area{};
  identity::write_head(identity::head_of(map), area.data());
  for (std::uint32_t i = 0; i < area.size(); ++i)
    values[{Table::input_registers, identity::reserved.start() + i}] = area[i];
}

std::size_t FakeDevice::count(const std::string& request) const {
  return static_cast<std::size_t>(std::count(requests.begin(), requests.end(), request));
}

Result<> FakeDevice::connect() {
  requests.emplace_back("connect");
  if (refuse_connect) return tl::make_unexpected(*refuse_connect);
  connected = true;
  return {};
}

Result<> FakeDevice::read_bits(Table table, modbus::Range range, std::uint8_t* bits) {
  return read(table, range, [&](std::uint32_t i, std::uint16_t value) { bits[i] = value != 0 ? 1 : 0; });
}

Result<> FakeDevice::read_registers(Table table, modbus::Range range, std::uint16_t* registers) {
  return read(table, range, [&](std::uint32_t i, std::uint16_t value) { registers[i] = value; });
}

Result<> FakeDevice::send(const modbus::WriteRequest&) {
  if (!connected) return fail(NotConnected{"not connected"});
  const std::lock_guard lock(mutex_);
  senders.push_back(std::this_thread::get_id());
  answered_ = true;
  woken_.notify_all();
  return {};
}

Result<> FakeDevice::receive(const modbus::WriteRequest& request) {
  {
    const std::lock_guard lock(mutex_);
    answered_ = false;
  }
  requests.push_back(describe(request));
  if (const auto error = planned()) return tl::make_unexpected(*error);
  return carry_out(request);
}

Transport::Woken FakeDevice::wait_until(Time time) {
  std::unique_lock lock(mutex_);
  const auto until = std::min(time, std::chrono::steady_clock::now() + std::chrono::hours(1));
  idle_ = true;
  woken_.notify_all();
  woken_.wait_until(lock, until, [this] { return called_ || answered_; });
  idle_ = false;
  const bool called = std::exchange(called_, false);
  woken_by_call = called && !answered_;
  if (answered_) return Woken::by_bytes;
  return called ? Woken::by_call : Woken::by_time;
}

void FakeDevice::await_idle() {
  std::unique_lock lock(mutex_);
  woken_.wait(lock, [this] { return idle_ && !called_ && !answered_; });
}

void FakeDevice::wake() {
  const std::lock_guard lock(mutex_);
  called_ = true;
  woken_.notify_all();
}

Result<> FakeDevice::read_file_record(std::uint16_t number, std::uint16_t record,
                                      Span<std::uint16_t> registers) {
  requests.push_back(fmt::format("read file {} {}+{}", number, record, registers.size()));
  if (const auto error = planned()) return tl::make_unexpected(*error);
  if (file.empty()) return fail(ExceptionReply{modbus::Exception::illegal_function});
  for (std::size_t i = 0; i < registers.size(); ++i) {
    const std::size_t at = 2 * ((number - 1) * std::size_t{modbus::records_per_file} + record + i);
    registers[i] = static_cast<std::uint16_t>(byte(at) << 8 | byte(at + 1));
  }
  return {};
}

std::optional<Error> FakeDevice::planned() {
  if (!connected) return Error(NotConnected{"not connected"});
  if (const auto code = refuses ? refuses(requests.back()) : std::nullopt)
    return Error(ExceptionReply{*code});
  if (next_errors.empty()) return std::nullopt;
  const Error error = next_errors.front();
  next_errors.pop_front();
  return error;
}

Result<> FakeDevice::read(Table table, modbus::Range range,
                          const std::function<void(std::uint32_t, std::uint16_t)>& put) {
  requests.push_back(fmt::format("read {} {}+{}", to_string(table), range.start(), range.count()));
  if (during_read) during_read();
  if (const auto error = planned()) return tl::make_unexpected(*error);
  for (std::uint32_t i = 0; i < range.count(); ++i)
    if (missing.count({table, range.start() + i}) != 0)
      return fail(ExceptionReply{modbus::Exception::illegal_data_address});
  for (std::uint32_t i = 0; i < range.count(); ++i) {
    const auto found = values.find({table, range.start() + i});
    put(i, found == values.end() ? std::uint16_t{0} : found->second);
  }
  return {};
}

Result<> FakeDevice::carry_out(const modbus::WriteRequest& request) {
  const auto parsed = modbus::parse_request(request.pdu());
  if (!parsed) return fail(ExceptionReply{parsed.error()});
  if (const auto* bits = std::get_if<modbus::WriteBits>(&*parsed))
    return put(Table::coils, bits->range,
               [&](std::uint32_t i) { return std::uint16_t(bits->packed[i / 8] >> i % 8 & 1); });
  if (const auto* registers = std::get_if<modbus::WriteRegisters>(&*parsed))
    return put(Table::holding_registers, registers->range,
               [&](std::uint32_t i) { return modbus::get_u16(&registers->values[2 * i]); });
  const auto& mask = std::get<modbus::MaskWrite>(*parsed);
  const std::uint16_t old = values[{Table::holding_registers, mask.range.start()}];
  return put(Table::holding_registers, mask.range, [&](std::uint32_t) {
    return static_cast<std::uint16_t>((old & mask.and_mask) | (mask.or_mask & ~mask.and_mask));
  });
}

Result<> FakeDevice::put(Table table, modbus::Range range,
                         const std::function<std::uint16_t(std::uint32_t)>& get) {
  for (std::uint32_t i = 0; i < range.count(); ++i)
    if (!missing_for_reads_only && missing.count({table, range.start() + i}) != 0)
      return fail(ExceptionReply{modbus::Exception::illegal_data_address});
  for (std::uint32_t i = 0; i < range.count(); ++i) values[{table, range.start() + i}] = get(i);
  return {};
}

}  // namespace coupler::host::test
