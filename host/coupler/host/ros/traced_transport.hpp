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
#include "coupler/map/functions.hpp"
#include "coupler/modbus/server.hpp"

namespace coupler::host {

/// Logs each request at ROS's debug level: what it was, its result, and how long it took. Knows when the last
/// read was sent.
class TracedTransport : public Transport {
 public:
  TracedTransport(std::string name, std::unique_ptr<Transport> transport, Node& log)
      : name_(std::move(name)), transport_(std::move(transport)), log_(log) {}

  /// The time at which the last exchange() began. Only its thread may call it.
  Time read_sent_at() const { return read_sent_; }

  Result<> connect() override {
    const Time begun = now();
    return trace(transport_->connect(), begun, [] { return "connect"; });
  }
  void close() override { transport_->close(); }
  void interrupt() override { transport_->interrupt(); }
  Result<modbus::Bytes> exchange(modbus::Bytes pdu) override {
    read_sent_ = now();
    return trace(transport_->exchange(pdu), read_sent_, [&] { return describe(pdu); });
  }
  Result<> send_pdu(modbus::Bytes pdu) override {
    write_sent_ = now();
    if (log_.shows_debug()) written_ = describe(pdu);
    return transport_->send_pdu(pdu);
  }
  Result<modbus::Bytes> receive_pdu() override {
    return trace(transport_->receive_pdu(), write_sent_, [&] { return written_; });
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
  bool can_wait() const override { return transport_->can_wait(); }
  Result<> send_wait(const modbus::ChangesRequest& request) override {
    return transport_->send_wait(request);
  }
  Result<> receive_wait() override { return transport_->receive_wait(); }
  std::optional<WaitAnswer> take_wait_answer() override {
    std::optional<WaitAnswer> answer = transport_->take_wait_answer();
    if (answer)
      trace(answer->reply ? nullptr : &answer->reply.error(), answer->sent,
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

  static std::string describe(modbus::Bytes pdu) {
    const auto request = modbus::parse_request(pdu);
    if (const auto* read = request ? std::get_if<modbus::Read>(&*request) : nullptr)
      return fmt::format("read {} {} to {}", to_string(table_of(read->function)), read->range.start(),
                         read->range.last());
    if (const auto* groups = request ? std::get_if<modbus::FileGroups>(&*request) : nullptr) {
      const modbus::FileRecord wanted = (*groups)[0];
      return fmt::format("read file {} from {}, {} registers", wanted.file, wanted.record, wanted.registers);
    }
    if (pdu[0] == static_cast<std::uint8_t>(modbus::Function::schedule_output))
      return fmt::format("schedule: {:02x}", fmt::join(pdu.begin() + 1, pdu.end(), " "));
    return fmt::format("write by FC {} at {}: {:02x}", pdu[0], modbus::get_u16(&pdu[1]),
                       fmt::join(pdu.begin() + 3, pdu.end(), " "));
  }

  template <class T, class Describe>
  Result<T> trace(Result<T> result, Time begun, Describe describe) {
    trace(result ? nullptr : &result.error(), begun, describe);
    return result;
  }
  template <class Describe>
  void trace(const Error* error, Time begun, Describe describe) {
    if (!log_.shows_debug()) return;
    const std::chrono::duration<double, std::milli> took = now() - begun;
    log_.log_debug(fmt::format("{}: {}: {} after {:.3f} ms", name_, describe(),
                               error == nullptr ? std::string("ok") : to_string(*error), took.count()));
  }

  std::string name_;
  std::unique_ptr<Transport> transport_;
  Node& log_;
  Time read_sent_{};
  Time write_sent_{};
  std::string written_;  ///< the write in progress, where it is shown
};

}  // namespace coupler::host
