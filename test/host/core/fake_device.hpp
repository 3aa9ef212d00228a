// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <condition_variable>
#include <deque>
#include <functional>
#include <map>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "coupler/map/map.hpp"
#include "coupler/modbus/server.hpp"
#include "test/host/core/share.hpp"

namespace coupler::host::test {

/// A Modbus device without a network: four tables, a list of what was asked, and the failures a test plans.
class FakeDevice : public Channel {
 public:
  std::map<std::pair<Table, std::uint32_t>, std::uint16_t> values;  ///< what is not in it reads as 0
  std::set<std::pair<Table, std::uint32_t>> missing;                ///< asked for: exception 02
  std::vector<std::string> requests;  ///< "read coils 0+3", "write register 5" …
  std::optional<Error> refuse_connect;
  std::deque<Error> next_errors;  ///< each for one request, before it does anything
  std::function<std::optional<modbus::Exception>(const std::string& request)> refuses;  ///< at the moment
  std::string file;                                                                     ///< what FC 20 gives
  bool connected = false;
  std::vector<std::thread::id> senders;  ///< of writes
  std::function<void()> during_read;     ///< what happens while a read waits for its answer
  std::optional<Error> fail_send;        ///< of each write
  bool woken_by_call = false;            ///< how the last wait_until() ended
  bool missing_for_reads_only = false;   ///< writes to what is missing are acknowledged
  bool can_wait_for_changes = true;      ///< it does not share its connection
  std::uint32_t epoch = 1;
  Duration clock_is_ahead{0};           ///< the device's
  std::vector<modbus::Change> changes;  ///< since the epoch began; the first has number 1
  std::uint64_t forgotten = 0;          ///< so many of them cannot be told any more
  std::optional<modbus::Exception> refuses_waits;
  bool ignores_waits = false;
  bool drops_waits = false;                       ///< a gateway before it does, and lets all else through
  bool begins_epochs = false;                     ///< with each answer to a wait
  bool holds_changes_back = false;                ///< counts one more than it tells
  bool answers_waits_early = false;               ///< as if something had changed
  std::function<void()> during_wait;              ///< what happens when a wait is sent
  std::vector<modbus::ScheduleOutput> scheduled;  ///< number i + 1; without the values
  std::vector<std::uint8_t> scheduled_values;     ///< of the last one
  std::set<std::uint16_t> decided;                ///< the numbers of those that are over
  std::vector<modbus::CancelOutputs> cancels;     ///< that were carried out
  std::function<Time()> now = [] { return std::chrono::steady_clock::now(); };

  FakeDevice();
  ~FakeDevice() override;

  /// The device is a node that serves `map`.
  void serve(const Map& map);
  /// It says so in its identity area, with the time of its watchdog in ms.
  void tell_changes(std::uint32_t watchdog_timeout = 0) { answer_functions(watchdog_timeout, false); }
  /// It tells changes and drives outputs at a time.
  void schedule_outputs() { answer_functions(0, true); }
  /// A scheduled output has this outcome now.
  void decide(std::uint16_t number, modbus::Change::Kind kind, modbus::Reason reason = modbus::Reason::none);
  /// A bit changes now.
  void change(Table table, std::uint16_t address, bool value);
  /// When a wait that is outstanding is answered, if nothing else comes; Time::max() if there is none.
  Time answers_wait_at() const;
  std::size_t count(const std::string& request) const;

  Result<> open(const Event& interrupt) override;
  void close() override {
    connected = false;
    wait_.reset();
  }
  void hang_up() override {}
  Result<> select(std::uint8_t, std::chrono::milliseconds) override { return {}; }
  Result<> send(modbus::Bytes pdu) override;
  /// Requests take effect when their answer is fetched.
  Result<modbus::Bytes> receive() override;
  bool can_wait() const override { return can_wait_for_changes; }
  Result<> send_wait(const modbus::ChangesRequest& request) override;
  Result<> receive_wait() override;
  std::optional<WaitAnswer> take_wait_answer() override { return std::exchange(wait_answer_, std::nullopt); }
  Woken wait_until(Time time, Wakeup& wakeup, const Event& interrupted) override;
  /// Until somebody waits in wait_until(), with nothing to wake him.
  void await_idle();

 protected:
  /// The request in progress.
  modbus::Bytes request() const { return {sent_.data(), sent_.size()}; }

 private:
  void answer_functions(std::uint32_t watchdog_timeout, bool schedules);
  std::optional<Error> planned();
  /// Each returns the size of the reply in reply_.
  Result<std::size_t> carry_out(modbus::Bytes pdu);
  Result<std::size_t> read(const modbus::Read& request);
  Result<std::size_t> read_file(const modbus::FileGroups& groups);
  Result<> write(Table table, modbus::Range range,
                 const std::function<std::uint16_t(std::uint32_t i)>& value);
  std::size_t reply_schedule(std::uint16_t number);
  /// Returns how many it cancels. It has begun those whose time has come.
  std::uint16_t cancel(const modbus::CancelOutputs& which);
  void answer_wait();
  std::uint8_t byte(std::size_t at) const {
    return at < file.size() ? static_cast<std::uint8_t>(file[at]) : 0;
  }

  std::vector<std::uint8_t> sent_;
  std::array<std::uint8_t, modbus::max_pdu_size> reply_{};
  std::optional<modbus::ChangesRequest> wait_;
  Time wait_sent_{};
  std::optional<WaitAnswer> wait_answer_;
  Wakeup answered_;  ///< a write has a reply
  std::mutex mutex_;
  std::condition_variable waits_;
  bool idle_ = false;  ///< somebody is in wait_until()
};

}  // namespace coupler::host::test
