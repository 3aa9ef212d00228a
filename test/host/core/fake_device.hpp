// SPDX-License-Identifier: Apache-2.0
#pragma once

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

#include "coupler/host/core/transport.hpp"
#include "coupler/map/map.hpp"

namespace coupler::host::test {

/// A Modbus device without a network: four tables, a list of what was asked, and the failures a test plans.
class FakeDevice : public Transport {
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
  std::function<bool()> await_read;      ///< what happens while a read waits for its turn; whether it gets it
  std::function<void()> await_write;     ///< what happens while a write waits for its turn
  std::function<void()> during_read;     ///< what happens while a read waits for its answer
  bool refuse_send = false;              ///< it is somebody else's turn
  bool woken_by_call = false;            ///< how the last wait_until() ended
  bool missing_for_reads_only = false;   ///< writes to what is missing are acknowledged

  FakeDevice();
  ~FakeDevice() override;

  /// The device is a node that serves `map`.
  void serve(const Map& map);
  std::size_t count(const std::string& request) const;

  Result<> connect() override;
  void close() override { connected = false; }
  void interrupt() override {}
  Result<> read_bits(Table table, modbus::Range range, std::uint8_t* bits) override;
  Result<> read_registers(Table table, modbus::Range range, std::uint16_t* registers) override;
  Turn await_turn(Time, bool) override { return !await_read || await_read() ? Turn::read : Turn::none; }
  void await_turn_to_write() override {
    if (await_write) await_write();
  }
  bool reserve() override { return !refuse_send; }
  Result<> send(const modbus::WriteRequest&) override;
  /// Requests take effect when their answer is fetched.
  Result<> receive(const modbus::WriteRequest& request) override;
  Woken wait_until(Time time) override;
  /// Until somebody waits in wait_until(), with nothing to wake him.
  void await_idle();
  void wake() override;
  Result<> read_file_record(std::uint16_t number, std::uint16_t record,
                            Span<std::uint16_t> registers) override;

 private:
  std::optional<Error> planned();
  Result<> read(Table table, modbus::Range range,
                const std::function<void(std::uint32_t i, std::uint16_t value)>& put);
  Result<> carry_out(const modbus::WriteRequest& request);
  Result<> put(Table table, modbus::Range range, const std::function<std::uint16_t(std::uint32_t i)>& get);
  std::uint8_t byte(std::size_t at) const {
    return at < file.size() ? static_cast<std::uint8_t>(file[at]) : 0;
  }

  std::mutex mutex_;
  std::condition_variable woken_;
  bool called_ = false;
  bool answered_ = false;
  bool idle_ = false;  ///< somebody is in wait_until()
};

}  // namespace coupler::host::test
