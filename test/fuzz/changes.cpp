// SPDX-License-Identifier: Apache-2.0
// What a driver makes of a device that claims to tell changes: its epochs, numbers and times may be anything.
// The input is a row of turns, each three bytes and a reply: how long it takes, what is scheduled meanwhile,
// and the size of the reply's PDU.
#include <algorithm>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <set>
#include <string>
#include <utility>

#include "coupler/host/core/change_listener.hpp"
#include "coupler/host/core/node_outputs.hpp"
#include "test/fuzz/require.hpp"
#include "test/host/core/fake_clock.hpp"
#include "test/host/core/share.hpp"

namespace coupler::fuzz {
namespace {

using host::Result;
using host::Stamp;
using host::Time;
using modbus::Bytes;

/// Answers waits with what it is given.
class Impostor : public host::Channel {
 public:
  explicit Impostor(host::Clock& clock) : clock_(clock) {}
  void will_answer(Bytes pdu) { pdu_ = pdu; }

  bool can_wait() const override { return true; }
  Result<> send_wait(const modbus::ChangesRequest& request) override {
    require(!sent_, "one wait is outstanding at a time");
    require(request.wait <= modbus::longest_wait, "a wait has its limit");
    sent_ = clock_.now();
    return {};
  }
  Result<> receive_wait() override {
    require(sent_.has_value(), "an answer is awaited after a request");
    const auto reply = modbus::parse_changes_reply(pdu_);
    if (reply)
      answer_ = host::WaitAnswer{*reply, *sent_, clock_.now()};
    else if (reply.error().exception)
      answer_ =
          host::WaitAnswer{host::fail(host::ExceptionReply{*reply.error().exception}), *sent_, clock_.now()};
    sent_.reset();
    if (!answer_) return host::fail(host::BadFrame{});
    return {};
  }
  std::optional<host::WaitAnswer> take_wait_answer() override { return std::exchange(answer_, std::nullopt); }

  Result<> open(const host::Event&) override { return {}; }
  void close() override { sent_.reset(); }
  void hang_up() override {}
  Result<> select(std::uint8_t, std::chrono::milliseconds) override { return {}; }
  Result<> send(Bytes) override { return {}; }
  Result<Bytes> receive() override { return unexpected(); }
  host::Woken wait_until(Time, host::Wakeup&, const host::Event&) override { return host::Woken::by_time; }

 private:
  static Result<Bytes> unexpected() {
    require(false, "a listener only waits for changes");
    return Bytes();
  }

  host::Clock& clock_;
  Bytes pdu_;
  std::optional<Time> sent_;
  std::optional<host::WaitAnswer> answer_;
};

/// Looks at all that is told.
class Witness final : public host::ChangeSink, public host::ScheduledListener, public host::Sink {
 public:
  explicit Witness(host::Clock& clock) : clock_(clock) {}
  void begin() { last_.reset(); }
  void expect(std::uint32_t number) { expected_.insert(number); }
  std::size_t expected() const { return expected_.size(); }

  void on_change(const modbus::Change& change, std::uint64_t number, Stamp stamp) override {
    using Kind = modbus::Change::Kind;
    require(change.kind != Kind::done && change.kind != Kind::cancelled && change.kind != Kind::failed,
            "outcomes are no changes of bits");
    require(!last_ || number > *last_, "numbers grow");
    last_ = number;
    look_at(stamp);
  }
  void on_gap() override {}
  void on_new_epoch() override { begin(); }
  void on_heard(std::uint64_t newest, std::optional<Stamp> stamp) override {
    require(!last_ || newest >= *last_, "the newest change is none that was told before");
    if (stamp) look_at(*stamp);
  }
  void on_end() override {}
  Time answer_wanted() override { return clock_.now() + std::chrono::seconds(1); }

  void on_outcome(const host::AcceptedWrite& which, host::ScheduledOutcome::Result, Stamp stamp,
                  const std::string&) override {
    require(expected_.erase(which.number) == 1, "each output has one outcome");
    look_at(stamp);
  }

  void on_values(Span<const std::uint32_t>) override {}
  void on_online(bool) override {}
  void on_report(host::Level, const std::string&) override {}

 private:
  void look_at(Stamp stamp) const {
    require(stamp.at <= clock_.now(), "nothing has happened in the time to come");
    require(stamp.uncertainty >= host::Duration::zero(), "an uncertainty is none below zero");
  }

  host::Clock& clock_;
  std::optional<std::uint64_t> last_;
  std::set<std::uint32_t> expected_;
};

class Connection {
 public:
  /// `passes`: a power of two in nanoseconds, up to nine minutes. `schedules`: 0, or in how many steps of 20
  /// ms.
  void turn(std::uint8_t passes, std::uint8_t schedules, Bytes reply) {
    if (!listener_.is_active()) {
      require(link_.connect().has_value(), "a node is there");
      witness_.begin();
      listener_.start(std::chrono::milliseconds(schedules));
    }
    if (listener_.asks_for_watchdog()) listener_.set_watchdog(std::chrono::milliseconds(schedules));
    require(listener_.due() - clock_.now() <= std::chrono::seconds(1), "a pause ends");
    if (schedules > 0) schedule(std::chrono::milliseconds(20) * schedules);
    impostor_.will_answer(reply);
    bool lives = listener_.step().has_value();
    clock_.advance(host::Duration(std::int64_t{1} << passes % 40));
    if (lives && listener_.is_waiting()) lives = listener_.receive().has_value();
    listener_.report_held_back();
    if (lives && listener_.is_active()) return;
    outputs_.lose("gone");
    listener_.stop();
    link_.close();
  }
  void end() {
    outputs_.lose("over");
    require(witness_.expected() == 0, "each output has an outcome");
  }

 private:
  void schedule(host::Duration in) {
    const Time due = clock_.now() + in;
    const auto node_due = outputs_.node_due(due, listener_.mapping());
    if (!node_due || outputs_.size() >= host::max_scheduled) return;
    host::AcceptedWrite accepted;
    accepted.number = ++number_;
    accepted.what.due = due;
    witness_.expect(accepted.number);
    outputs_.add(static_cast<std::uint16_t>(number_ % 16), *node_due, accepted);
  }

  host::test::FakeClock clock_;
  Impostor impostor_{clock_};
  Witness witness_{clock_};
  host::DeviceStatistics statistics_;
  host::Link link_{host::test::share(impostor_), {}, {}, &clock_};
  host::NodeOutputs outputs_{witness_, clock_, witness_};
  host::ChangeListener listener_{std::chrono::milliseconds(100), link_, statistics_, outputs_, witness_};
  std::uint32_t number_ = 0;
};

}  // namespace
}  // namespace coupler::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  coupler::modbus::Bytes input(data, size);
  coupler::fuzz::Connection connection;
  while (input.size() >= 3) {
    const auto reply = input.from(3).first(std::min<std::size_t>(input[2], input.size() - 3));
    connection.turn(input[0], input[1], reply);
    input = input.from(3 + reply.size());
  }
  connection.end();
  return 0;
}
