// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "coupler/host/core/transport.hpp"
#include "coupler/host/ros/node.hpp"

namespace coupler::host {

/// Logs each request at ROS's debug level: what it was, its result, and how long it took. Knows when the last
/// read was sent.
class TracedTransport : public Transport {
 public:
  TracedTransport(std::string name, std::unique_ptr<Transport> transport, Node& log)
      : name_(std::move(name)), transport_(std::move(transport)), log_(log) {}

  /// Of the last read. In its thread only.
  Time read_sent_at() const { return read_sent_; }

  Result<> connect() override {
    const Time begun = now();
    return trace(transport_->connect(), begun, [] { return "connect"; });
  }
  void close() override { transport_->close(); }
  void interrupt() override { transport_->interrupt(); }
  Result<> read_bits(Table table, modbus::Range range, std::uint8_t* bits) override {
    read_sent_ = now();
    return trace(transport_->read_bits(table, range, bits), read_sent_,
                 [&] { return describe_read(table, range); });
  }
  Result<> read_registers(Table table, modbus::Range range, std::uint16_t* registers) override {
    read_sent_ = now();
    return trace(transport_->read_registers(table, range, registers), read_sent_,
                 [&] { return describe_read(table, range); });
  }
  Result<> read_file_record(std::uint16_t file, std::uint16_t record,
                            Span<std::uint16_t> registers) override {
    read_sent_ = now();
    return trace(transport_->read_file_record(file, record, registers), read_sent_, [&] {
      return fmt::format("read file {} from {}, {} registers", file, record, registers.size());
    });
  }
  void rank(Rank rank) override { transport_->rank(rank); }
  Turn await_turn(Time until, bool write_waits = false) override {
    return transport_->await_turn(until, write_waits);
  }
  void await_turn_to_write(const std::function<bool()>& ends) override {
    transport_->await_turn_to_write(ends);
  }
  bool reserve() override { return transport_->reserve(); }
  void give_back() override { transport_->give_back(); }
  Result<> send(const modbus::WriteRequest& request) override {
    write_sent_ = now();
    return transport_->send(request);
  }
  Result<> receive(const modbus::WriteRequest& request) override {
    return trace(transport_->receive(request), write_sent_, [&] {
      return fmt::format("write by FC {} at {}: {:02x}", static_cast<int>(request.function()),
                         request.address(), fmt::join(request.pdu().begin() + 3, request.pdu().end(), " "));
    });
  }
  Result<modbus::ScheduleReply> schedule(const modbus::ScheduleRequest& request) override {
    const Time begun = now();
    Result<modbus::ScheduleReply> reply = transport_->schedule(request);
    trace(reply ? Result<>{} : tl::make_unexpected(reply.error()), begun, [&] {
      return fmt::format("schedule: {:02x}", fmt::join(request.pdu().begin() + 1, request.pdu().end(), " "));
    });
    return reply;
  }
  bool can_wait() const override { return transport_->can_wait(); }
  Result<> send_wait(const modbus::ChangesRequest& request) override {
    return transport_->send_wait(request);
  }
  Result<> receive_wait() override { return transport_->receive_wait(); }
  std::optional<WaitAnswer> take_wait_answer() override {
    std::optional<WaitAnswer> answer = transport_->take_wait_answer();
    if (answer)
      trace(answer->reply ? Result<>{} : tl::make_unexpected(answer->reply.error()), answer->sent,
            [&] { return fmt::format("wait for changes: {}", answer->reply ? answer->reply->count : 0); });
    return answer;
  }
  Result<> discard_unasked() override { return transport_->discard_unasked(); }
  std::uint64_t discarded() const override { return transport_->discarded(); }
  std::optional<Certificates> certificates() const override { return transport_->certificates(); }
  Woken wait_until(Time time) override { return transport_->wait_until(time); }
  void wake() override { transport_->wake(); }

 private:
  static Time now() { return std::chrono::steady_clock::now(); }

  static std::string describe_read(Table table, modbus::Range range) {
    return fmt::format("read {} {} to {}", to_string(table), range.start(), range.last());
  }

  template <class Describe>
  Result<> trace(Result<> result, Time begun, Describe describe) {
    if (!log_.shows_debug()) return result;
    const std::chrono::duration<double, std::milli> took = now() - begun;
    log_.log_debug(fmt::format("{}: {}: {} after {:.3f} ms", name_, describe(),
                               result ? std::string("ok") : to_string(result.error()), took.count()));
    return result;
  }

  std::string name_;
  std::unique_ptr<Transport> transport_;
  Node& log_;
  Time read_sent_{};
  Time write_sent_{};
};

}  // namespace coupler::host
