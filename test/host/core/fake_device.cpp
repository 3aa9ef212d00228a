// SPDX-License-Identifier: Apache-2.0
#include "test/host/core/fake_device.hpp"

#include <poll.h>

#include <algorithm>
#include <array>

#include <fmt/format.h>

#include "coupler/map/functions.hpp"
#include "coupler/map/identity.hpp"

namespace coupler::host::test {
namespace {

std::string describe(const modbus::Read& read) {
  return fmt::format("read {} {}+{}", to_string(table_of(read.function)), read.range.start(),
                     read.range.count());
}

/// "read coils 0+3", "write coil 5", "write registers 7+4", "write mask 3" …
std::string describe(modbus::Bytes pdu) {
  const auto request = modbus::parse_request(pdu);
  if (!request) return "schedule";  // all else that the driver sends is right
  if (const auto* read = std::get_if<modbus::Read>(&*request)) return describe(*read);
  if (const auto* groups = std::get_if<modbus::FileGroups>(&*request))
    return fmt::format("read file {} {}+{}", (*groups)[0].file, (*groups)[0].record, (*groups)[0].registers);
  if (const auto* cancel = std::get_if<modbus::CancelOutput>(&*request))
    return fmt::format("cancel {}", cancel->number);
  if (const auto* cancel = std::get_if<modbus::CancelOutputs>(&*request))
    return fmt::format("cancel {} {}+{}", to_string(table_of(cancel->table)), cancel->range.start(),
                       cancel->range.count());
  const bool is_single = pdu.size() == 5;
  if (const auto* bits = std::get_if<modbus::WriteBits>(&*request))
    return is_single ? fmt::format("write coil {}", bits->range.start())
                     : fmt::format("write coils {}+{}", bits->range.start(), bits->range.count());
  if (const auto* words = std::get_if<modbus::WriteRegisters>(&*request))
    return is_single ? fmt::format("write register {}", words->range.start())
                     : fmt::format("write registers {}+{}", words->range.start(), words->range.count());
  if (const auto* mask = std::get_if<modbus::MaskWrite>(&*request))
    return fmt::format("write mask {}", mask->range.start());
  return "schedule";
}

bool is_write(modbus::Bytes pdu) {
  const auto request = modbus::parse_request(pdu);
  return request && (std::holds_alternative<modbus::WriteBits>(*request) ||
                     std::holds_alternative<modbus::WriteRegisters>(*request) ||
                     std::holds_alternative<modbus::MaskWrite>(*request));
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
  decided.insert(number);
  changes.push_back(
      {static_cast<std::uint8_t>(reason), kind, number, now().time_since_epoch() + clock_is_ahead});
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

Result<> FakeDevice::open(const Event&) {
  requests.emplace_back("connect");
  if (refuse_connect) return tl::make_unexpected(*refuse_connect);
  connected = true;
  return {};
}

Result<> FakeDevice::send(modbus::Bytes pdu) {
  if (!connected) return fail(NotConnected{"not connected"});
  sent_.assign(pdu.begin(), pdu.end());
  if (!is_write(pdu)) return {};
  if (fail_send) return tl::make_unexpected(*fail_send);
  const std::lock_guard lock(mutex_);
  senders.push_back(std::this_thread::get_id());
  answered_.call();
  return {};
}

Result<modbus::Bytes> FakeDevice::receive() {
  answered_.clear();
  answer_wait();
  requests.push_back(describe(request()));
  const bool is_read = sent_[0] <= static_cast<std::uint8_t>(modbus::Function::read_input_registers);
  if (is_read && during_read) during_read();
  if (const auto error = planned()) return tl::make_unexpected(*error);
  const auto size = carry_out(request());
  if (!size) return tl::make_unexpected(size.error());
  return modbus::Bytes(reply_).first(*size);
}

Woken FakeDevice::wait_until(Time time, Wakeup& wakeup, const Event& interrupted) {
  {
    const std::lock_guard lock(mutex_);
    pollfd called{wakeup.fd(), POLLIN, 0};
    idle_ = ::poll(&called, 1, 0) == 0;
    waits_.notify_all();
  }
  const Woken woken = wait_for(wakeup, &interrupted, answered_.fd(), time);
  const std::lock_guard lock(mutex_);
  idle_ = false;
  woken_by_call = woken == Woken::by_call;
  return woken;
}

void FakeDevice::await_idle() {
  std::unique_lock lock(mutex_);
  waits_.wait(lock, [this] { return idle_; });
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

Result<std::size_t> FakeDevice::carry_out(modbus::Bytes pdu) {
  const auto request = modbus::parse_request(pdu);
  if (!request) return fail(ExceptionReply{request.error()});
  if (const auto* wanted = std::get_if<modbus::Read>(&*request)) return read(*wanted);
  if (const auto* groups = std::get_if<modbus::FileGroups>(&*request)) return read_file(*groups);
  if (const auto* cancel = std::get_if<modbus::CancelOutput>(&*request))
    return reply_schedule(cancel->number);
  if (const auto* cancel = std::get_if<modbus::CancelOutputs>(&*request))
    return reply_schedule(this->cancel(*cancel));
  if (const auto* output = std::get_if<modbus::ScheduleOutput>(&*request)) {
    scheduled.push_back(*output);
    const modbus::Bytes packed = std::exchange(scheduled.back().values, {});
    scheduled_values.assign(packed.begin(), packed.end());
    return reply_schedule(static_cast<std::uint16_t>(scheduled.size()));
  }
  Result<> done;
  if (const auto* bits = std::get_if<modbus::WriteBits>(&*request))
    done = write(Table::coils, bits->range,
                 [&](std::uint32_t i) { return std::uint16_t(bits->packed[i / 8] >> i % 8 & 1); });
  if (const auto* words = std::get_if<modbus::WriteRegisters>(&*request))
    done = write(Table::holding_registers, words->range,
                 [&](std::uint32_t i) { return modbus::get_u16(&words->values[2 * i]); });
  if (const auto* mask = std::get_if<modbus::MaskWrite>(&*request))
    done = write(Table::holding_registers, mask->range, [&](std::uint32_t) {
      const std::uint16_t old = values[{Table::holding_registers, mask->range.start()}];
      return static_cast<std::uint16_t>((old & mask->and_mask) | (mask->or_mask & ~mask->and_mask));
    });
  if (!done) return tl::make_unexpected(done.error());
  return modbus::reply_written(pdu, reply_);
}

Result<std::size_t> FakeDevice::read(const modbus::Read& request) {
  const Table table = table_of(request.function);
  std::vector<std::uint16_t> found;
  for (std::uint32_t i = request.range.start(); i < request.range.end(); ++i) {
    if (missing.count({table, i}) != 0) return fail(ExceptionReply{modbus::Exception::illegal_data_address});
    const auto value = values.find({table, i});
    found.push_back(value == values.end() ? std::uint16_t{0} : value->second);
  }
  const Span<const std::uint16_t> all(found.data(), found.size());
  return holds_bits(table) ? modbus::reply_bits(request.function, all, reply_)
                           : modbus::reply_registers(request.function, all, reply_);
}

Result<std::size_t> FakeDevice::read_file(const modbus::FileGroups& groups) {
  if (file.empty()) return fail(ExceptionReply{modbus::Exception::illegal_function});
  const modbus::FileRecord wanted = groups[0];
  modbus::FileReply reply(reply_);
  const auto bytes = reply.add(wanted.registers);
  const std::size_t first = 2 * ((wanted.file - 1) * std::size_t{modbus::records_per_file} + wanted.record);
  for (std::size_t i = 0; i < bytes.size(); ++i) bytes[i] = byte(first + i);
  return reply.size();
}

std::size_t FakeDevice::reply_schedule(std::uint16_t number) {
  const modbus::NodeTime at = now().time_since_epoch() + clock_is_ahead;
  return modbus::reply_schedule({number, at, at}, reply_);
}

std::uint16_t FakeDevice::cancel(const modbus::CancelOutputs& which) {
  cancels.push_back(which);
  const modbus::NodeTime at = now().time_since_epoch() + clock_is_ahead;
  std::uint16_t count = 0;
  for (std::size_t i = 0; i < scheduled.size(); ++i) {
    const modbus::ScheduleOutput& one = scheduled[i];
    if (one.due < which.from || one.due <= at || one.table != which.table || !one.range.overlaps(which.range))
      continue;
    if (decided.insert(static_cast<std::uint16_t>(i + 1)).second) ++count;
  }
  return count;
}

Result<> FakeDevice::write(Table table, modbus::Range range,
                           const std::function<std::uint16_t(std::uint32_t)>& value) {
  for (std::uint32_t i = 0; i < range.count(); ++i)
    if (!missing_for_reads_only && missing.count({table, range.start() + i}) != 0)
      return fail(ExceptionReply{modbus::Exception::illegal_data_address});
  for (std::uint32_t i = 0; i < range.count(); ++i) values[{table, range.start() + i}] = value(i);
  return {};
}

}  // namespace coupler::host::test
