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

void FakeDevice::answer_functions(std::uint32_t watchdog_timeout, bool schedules) {
  identity::Further further;
  further.functions.tells_changes = true;
  further.functions.schedules_outputs = schedules;
  further.watchdog_timeout = watchdog_timeout;
  std::array<std::uint16_t, identity::size> area{};
  identity::write_further(further, area.data());
  for (std::uint32_t i = identity::at_further; i < area.size(); ++i)
    values[{Table::input_registers, identity::reserved.start() + i}] = area[i];
}

void FakeDevice::change(Table table, std::uint16_t address, bool value) {
  values[{table, address}] = value ? 1 : 0;
  using Kind = modbus::Change::Kind;
  changes.push_back({static_cast<std::uint8_t>(table == Table::coils ? 1 : 2), value ? Kind::on : Kind::off,
                     address, now().time_since_epoch() + clock_is_ahead});
}

void FakeDevice::decide(std::uint16_t number, modbus::Change::Kind kind, modbus::Reason reason) {
  changes.push_back(
      {static_cast<std::uint8_t>(reason), kind, number, now().time_since_epoch() + clock_is_ahead});
}

Result<modbus::ScheduleReply> FakeDevice::schedule(const modbus::ScheduleRequest& request) {
  answer_wait();
  const auto parsed = modbus::parse_schedule_request(request.pdu());
  const auto* const cancel = parsed ? std::get_if<modbus::CancelOutput>(&*parsed) : nullptr;
  requests.push_back(cancel != nullptr ? fmt::format("cancel {}", cancel->number) : "schedule");
  if (const auto error = planned()) return tl::make_unexpected(*error);
  if (!parsed) return fail(ExceptionReply{parsed.error()});
  if (cancel != nullptr) return modbus::ScheduleReply{cancel->number, {}, {}};
  scheduled.push_back(std::get<modbus::ScheduleOutput>(*parsed));
  const modbus::Bytes packed = std::exchange(scheduled.back().values, {});
  scheduled_values.assign(packed.begin(), packed.end());
  return modbus::ScheduleReply{static_cast<std::uint16_t>(scheduled.size()), {}, {}};
}

Result<> FakeDevice::send_wait(const modbus::ChangesRequest& request) {
  if (!connected) return fail(NotConnected{"not connected"});
  requests.push_back(fmt::format("wait {}", request.wait));
  wait_ = request;
  wait_sent_ = now();
  if (during_wait) during_wait();
  return {};
}

Time FakeDevice::answers_wait_at() const {
  if (!wait_ || ignores_waits || drops_waits) return Time::max();
  const bool has_news = wait_->epoch != epoch || wait_->seen < changes.size() || refuses_waits ||
                        begins_epochs || answers_waits_early || holds_changes_back;
  return has_news ? wait_sent_ : wait_sent_ + std::chrono::milliseconds(wait_->wait);
}

Result<> FakeDevice::receive_wait() {
  if (!connected) return fail(NotConnected{"not connected"});
  if (answers_wait_at() > now()) return fail(Timeout{std::chrono::milliseconds(1000)});
  if (const auto error = planned()) return tl::make_unexpected(*error);
  answer_wait();
  return {};
}

void FakeDevice::answer_wait() {
  if (drops_waits) return;
  const auto wait = std::exchange(wait_, std::nullopt);
  if (!wait) return;
  if (refuses_waits) {
    wait_answer_ = WaitAnswer{fail(ExceptionReply{*refuses_waits}), wait_sent_, now()};
    return;
  }
  if (begins_epochs) ++epoch;
  modbus::ChangesReply reply;
  reply.epoch = epoch;
  reply.arrived = wait_sent_.time_since_epoch() + clock_is_ahead;
  reply.replied = now().time_since_epoch() + clock_is_ahead;
  reply.newest = changes.size();
  if (wait->epoch == epoch) {
    const std::uint64_t first = std::max(wait->seen, forgotten);
    reply.lost = static_cast<std::uint32_t>(first - wait->seen);
    for (auto i = first; i < changes.size() && reply.count < modbus::max_changes; ++i)
      reply.changes[reply.count++] = changes[i];
  }
  if (holds_changes_back) {
    reply.newest = wait->seen + 1;
    reply.count = 0;
    reply.lost = 0;
  }
  wait_answer_ = WaitAnswer{reply, wait_sent_, now()};
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
  if (fail_send) return tl::make_unexpected(*fail_send);
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
  answer_wait();
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
  if (wait_ && drops_waits) return Error(BadFrame{"the reply to another request"});
  if (const auto code = refuses ? refuses(requests.back()) : std::nullopt)
    return Error(ExceptionReply{*code});
  if (next_errors.empty()) return std::nullopt;
  const Error error = next_errors.front();
  next_errors.pop_front();
  return error;
}

Result<> FakeDevice::read(Table table, modbus::Range range,
                          const std::function<void(std::uint32_t, std::uint16_t)>& put) {
  answer_wait();
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
