// SPDX-License-Identifier: Apache-2.0
#include "host/core/device.hpp"

#include <utility>

#include <fmt/format.h>

#include "common/map/fingerprint.hpp"

namespace coupler::driver {

Device::Device(const Map& map, Verify verify, MapLoader load, Transport& transport, Clock& clock,
               WriteQueue& writes, Sink& sink)
    : map_(map),
      verify_(verify),
      load_(std::move(load)),
      transport_(transport, clock, map.limits),
      clock_(clock),
      writes_(writes),
      sink_(sink),
      cycle_(map) {}

Time Device::step() {
  if (!connected_) {
    drop_writes();
    if (clock_.now() < retry_at_) return retry_at_;
    return connect();
  }
  if (const auto next = writes_.take()) {
    write(*next);
  } else if (cycle_.select(clock_.now()) != nullptr) {
    read();
    for (const Refusal& refusal : cycle_.take_refusals()) sink_.on_report(Level::warning, to_string(refusal));
  }
  return connected_ ? cycle_.due() : retry_at_;
}

void Device::stop() {
  transport_.close();
  connected_ = false;
  if (std::exchange(online_, false)) sink_.on_online(false);
}

Time Device::connect() {
  Result<> result = transport_.connect();
  const bool linked = result.has_value();
  if (linked && verify_ != Verify::off) result = prove_equal();
  if (!result) {
    lost(result.error());
    return retry_at_;
  }
  connected_ = true;
  cycle_.start(clock_.now());
  if (verify_ != Verify::off) came_online();
  return cycle_.due();
}

Result<> Device::prove_equal() {
  const Result<Identity> identity = check_identity(transport_, map_, load_);
  if (!identity) {
    explain_silence(identity.error());
    return tl::make_unexpected(identity.error());
  }
  return judge(*identity);
}

void Device::explain_silence(const Error& error) {
  if (!std::holds_alternative<Timeout>(error) || std::exchange(silence_told_, true)) return;
  sink_.on_report(Level::warning,
                  "connected, but the question for the device's identity is not answered; if this is a "
                  "foreign coupler that ignores addresses it does not have, start with _verify:=off");
}

Result<> Device::judge(const Identity& identity) {
  if (identity.verdict != Identity::Verdict::different) {
    refused_fingerprint_ = 0;
    if (identity.verdict == Identity::Verdict::superset)
      sink_.on_report(Level::info,
                      "the device has more points than this map; those of this map are unchanged");
    return {};
  }
  const bool refuse = verify_ == Verify::require;
  if (std::exchange(refused_fingerprint_, identity.fingerprint) != identity.fingerprint) {
    std::string text =
        fmt::format("the map differs from the device's: fingerprint {} here, {} in the device",
                    fingerprint_text(map_.fingerprint), fingerprint_text(identity.fingerprint));
    for (const std::string& line : identity.differences) text += "\n  " + line;
    if (refuse)
      text += "\nNothing is read or written. Give both sides the same map, or accept it with _verify:=warn";
    sink_.on_report(refuse ? Level::error : Level::warning, text);
  }
  if (refuse) return fail(NotConnected{"the device's map is another one"});
  return {};
}

void Device::write(const Write& write) {
  const std::string_view name = map_.points[write.point].name;
  const Result<> result = perform(write, map_, transport_);
  if (!result && exception_in(result.error()) == nullptr) {
    sink_.on_report(Level::warning, fmt::format("write to {} lost: {}", name, to_string(result.error())));
    lost(result.error());
    return;
  }
  came_online();
  if (!result)
    sink_.on_report(Level::warning, fmt::format("write to {} refused: {}", name, to_string(result.error())));
}

void Device::drop_writes() {
  while (const auto write = writes_.take()) {
    if (dropped_writes_++ == 0)
      sink_.on_report(Level::warning,
                      fmt::format("write to {} dropped, as all until the device is back: not connected",
                                  map_.points[write->point].name));
  }
}

void Device::read() {
  const ReadSpan& span = cycle_.current();
  const std::uint32_t count = span.range.count();
  const bool bits = holds_bits(span.table);
  const Result<> result = bits ? transport_.read_bits(span.table, span.range, bits_.data())
                               : transport_.read_registers(span.table, span.range, registers_.data());
  if (!result) {
    handle_read_error(result.error());
    return;
  }
  came_online();
  if (bits)
    sink_.on_bits(span, {bits_.data(), count}, clock_.now());
  else
    sink_.on_registers(span, {registers_.data(), count}, clock_.now());
  const std::string name = cycle_.failing() ? describe(span) : std::string();
  if (cycle_.answered(std::nullopt, clock_.now())) sink_.on_report(Level::info, name + " can be read again");
}

void Device::handle_read_error(const Error& error) {
  const ExceptionReply* exception = exception_in(error);
  if (exception == nullptr) {
    lost(error);
    return;
  }
  came_online();
  rejected_read(exception->code);
}

void Device::rejected_read(modbus::Exception code) {
  const std::string name = describe(cycle_.current());
  const std::string why = to_string(Error(ExceptionReply{code}));
  switch (code) {
    // Devices answer a range that they do not have, or that is too long for them, with either of these.
    case modbus::Exception::illegal_data_address:
    case modbus::Exception::illegal_data_value:
      for (const std::uint32_t point : cycle_.rejected(clock_.now()))
        sink_.on_report(Level::warning,
                        fmt::format("{} is not in the device: {}; it is not asked for again while "
                                    "this connection lasts",
                                    map_.points[point].name, why));
      return;
    case modbus::Exception::illegal_function:
      cycle_.give_up(clock_.now());
      sink_.on_report(Level::warning,
                      fmt::format("{} cannot be read: {}; it is not asked for again while this "
                                  "connection lasts",
                                  name, why));
      return;
    default:
      if (cycle_.answered(code, clock_.now()))
        sink_.on_report(Level::warning, fmt::format("{} cannot be read now: {}", name, why));
  }
}

void Device::came_online() {
  if (std::exchange(online_, true)) return;
  backoff_.reset();
  last_trouble_.clear();
  silence_told_ = false;
  sink_.on_online(true);
  if (dropped_writes_ > 0)
    sink_.on_report(Level::warning, fmt::format("connected; {} writes were dropped meanwhile",
                                                std::exchange(dropped_writes_, 0)));
  else
    sink_.on_report(Level::info, "connected");
}

void Device::lost(const Error& error) {
  transport_.close();
  connected_ = false;
  retry_at_ = clock_.now() + backoff_.next();
  const std::string why = to_string(error);
  if (std::exchange(online_, false)) {
    sink_.on_online(false);
    sink_.on_report(Level::warning, fmt::format("connection lost: {}; connecting again", why));
  } else if (why != last_trouble_) {
    sink_.on_report(Level::warning, fmt::format("not connected: {}; trying again", why));
  }
  last_trouble_ = why;
}

std::string Device::describe(const ReadSpan& span) const {
  if (span.points.size() == 1) return std::string(map_.points[span.points.front()].name);
  return fmt::format("{} {} to {} ({} to {})", to_string(span.table), span.range.start(), span.range.last(),
                     map_.points[span.points.front()].name, map_.points[span.points.back()].name);
}

}  // namespace coupler::driver
