// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/modbus/unit_transport.hpp"

#include <gtest/gtest.h>

#include <future>
#include <map>
#include <thread>

#include "coupler/host/core/device_thread.hpp"
#include "coupler/host/core/write.hpp"
#include "coupler/host/modbus/make_transports.hpp"
#include "test/fakes/map_builder.hpp"
#include "test/host/modbus/modbus_server.hpp"

namespace coupler::host {
namespace {

using modbus::Range;
using modbus::WriteRequest;
using std::chrono::milliseconds;

/// Takes one connection at a time. Each unit has registers with a hundred times its number; writes of one
/// value are acknowledged.
class Gateway {
 public:
  std::atomic<int> silent{-1};             ///< the unit that never answers
  std::atomic<int> away{-1};               ///< the unit that is answered for with exception 0B
  std::atomic<bool> ends{false};           ///< hangs up instead of the next answer
  std::atomic<int> ends_each{0};           ///< hangs up after so many requests, again and again; 0: never
  std::atomic<int> held{-1};               ///< the unit whose reads are not answered for now
  std::atomic<bool> holds{false};          ///< a read of it has come
  std::atomic<int> reads{0};               ///< so many have come
  std::atomic<int> reads_before_write{0};  ///< `reads` when the last write came

  std::uint16_t port() const { return server_.port(); }

 private:
  bool answer(int fd) {
    std::array<std::uint8_t, 12> query{};
    if (::recv(fd, query.data(), query.size(), MSG_WAITALL) != static_cast<ssize_t>(query.size()))
      return false;
    if (ends.exchange(false) || (ends_each > 0 && ++requests_ % ends_each == 0)) return false;
    const std::uint8_t unit = query[6];
    if (query[7] == 3)
      ++reads;
    else
      reads_before_write = reads.load();
    while (query[7] == 3 && unit == held) {
      holds = true;
      std::this_thread::sleep_for(milliseconds(1));
    }
    holds = false;
    if (unit == silent) return true;
    const auto refused = static_cast<std::uint8_t>(query[7] | 0x80U);
    if (unit == away) return reply(fd, query, {unit, refused, 0x0B});
    if (query[7] != 3) return ::send(fd, query.data(), query.size(), MSG_NOSIGNAL) > 0;
    const unsigned value = 100U * unit;
    return reply(fd, query,
                 {unit, 3, 2, static_cast<std::uint8_t>(value >> 8U), static_cast<std::uint8_t>(value)});
  }
  static bool reply(int fd, const std::array<std::uint8_t, 12>& query, std::vector<std::uint8_t> rest) {
    std::vector<std::uint8_t> adu{query[0], query[1], 0, 0, 0, static_cast<std::uint8_t>(rest.size())};
    adu.insert(adu.end(), rest.begin(), rest.end());
    return ::send(fd, adu.data(), adu.size(), MSG_NOSIGNAL) > 0;
  }

  int requests_ = 0;
  test::LoopbackServer server_{[this](int fd) { return answer(fd); }};  // last: its thread uses the others
};

struct UnitTransportTest : testing::Test {
  static constexpr std::uint8_t units = 3;

  MapPtr make_map(std::uint8_t unit, std::uint16_t connections = 1) const {
    fakes::MapBuilder builder;
    builder.add(Table::holding_registers, "level", 1, codec::Type::UINT);
    const auto known = patience.find(unit);
    builder.head().connection = {"localhost", port, unit,
                                 known == patience.end() ? milliseconds(20000) : known->second};
    builder.head().limits.connections = connections;
    builder.head().polling.rate = 200;
    return builder.build();
  }
  void make(std::uint16_t connections = 1) {
    std::vector<Map> maps;
    for (std::uint8_t unit = 1; unit <= units; ++unit)
      maps.push_back(owned.emplace_back(make_map(unit, connections))->map());
    transports = make_transports(maps);
  }
  void connect_all() {
    make();
    for (const auto& transport : transports) ASSERT_TRUE(transport->connect());
  }
  Transport& unit(int number) { return *transports[static_cast<std::size_t>(number - 1)]; }
  Result<> read(int number) {
    return unit(number).read_registers(Table::holding_registers, Range::of(1, 1), &word);
  }

  Gateway gateway;
  std::uint16_t port = gateway.port();
  std::map<std::uint8_t, milliseconds> patience;  ///< of a unit's transport, where it is to end
  std::uint16_t word = 0;
  std::vector<MapPtr> owned;
  std::vector<std::unique_ptr<Transport>> transports;
};

TEST_F(UnitTransportTest, Units_behind_one_gateway_share_its_connection) {
  connect_all();
  for (int number = 1; number <= units; ++number) {
    ASSERT_TRUE(read(number));
    EXPECT_EQ(word, 100 * number);
  }
}

TEST_F(UnitTransportTest, Where_the_limits_allow_it_each_has_a_connection_of_its_own) {
  make(units);
  for (const auto& transport : transports)
    EXPECT_NE(dynamic_cast<ModbusTransport*>(transport.get()), nullptr);
}

TEST_F(UnitTransportTest, A_silent_unit_costs_the_others_time_but_not_their_connection) {
  patience[2] = milliseconds(200);
  connect_all();
  gateway.silent = 2;
  EXPECT_TRUE(std::holds_alternative<Timeout>(read(2).error()));
  unit(2).close();
  EXPECT_TRUE(read(1));
  EXPECT_TRUE(read(3));
}

TEST_F(UnitTransportTest, A_unit_that_is_away_leaves_the_connection_alone) {
  connect_all();
  gateway.away = 2;
  EXPECT_TRUE(is_unit_away(read(2).error()));
  EXPECT_TRUE(read(1));
}

TEST_F(UnitTransportTest, A_gateway_that_hangs_up_is_lost_for_all_until_each_has_connected_again) {
  connect_all();
  gateway.ends = true;
  EXPECT_FALSE(read(1));
  ASSERT_TRUE(unit(1).connect());
  EXPECT_TRUE(read(1));
  EXPECT_TRUE(std::holds_alternative<TransportFailure>(read(3).error()));
  ASSERT_TRUE(unit(3).connect());
  EXPECT_TRUE(read(3));
}

TEST_F(UnitTransportTest, A_write_is_not_sent_straight_through_while_another_unit_has_its_turn) {
  connect_all();
  const auto request = WriteRequest::register_value(1, 7);
  ASSERT_TRUE(unit(1).reserve());
  ASSERT_TRUE(unit(1).send(request));
  EXPECT_FALSE(unit(2).reserve());
  EXPECT_TRUE(unit(1).receive(request));
  ASSERT_TRUE(unit(2).reserve());
  ASSERT_TRUE(unit(2).send(request));
  EXPECT_TRUE(unit(2).receive(request));
}

TEST_F(UnitTransportTest, Who_closes_while_its_answer_is_to_come_gives_its_turn_back) {
  connect_all();
  ASSERT_TRUE(unit(1).send(WriteRequest::register_value(1, 7)));
  unit(1).close();
  EXPECT_TRUE(read(2));
}

TEST_F(UnitTransportTest, Who_closes_does_not_wait_for_the_requests_of_others) {
  connect_all();
  const auto request = WriteRequest::register_value(1, 7);
  ASSERT_TRUE(unit(1).send(request));
  auto closing = std::async(std::launch::async, [this] { unit(2).close(); });
  EXPECT_EQ(closing.wait_for(std::chrono::seconds(20)), std::future_status::ready);
  EXPECT_TRUE(unit(1).receive(request));
}

TEST_F(UnitTransportTest, The_last_one_that_closes_ends_the_connection) {
  connect_all();
  for (const auto& transport : transports) transport->close();
  ModbusTransport another(owned[0]->map().connection);  // the gateway serves one at a time
  ASSERT_TRUE(another.connect());
  EXPECT_TRUE(another.read_registers(Table::holding_registers, Range::of(1, 1), &word));
}

TEST_F(UnitTransportTest, A_read_that_waits_for_its_turn_makes_room_when_its_unit_is_woken) {
  connect_all();
  const auto request = WriteRequest::register_value(1, 7);
  ASSERT_TRUE(unit(1).send(request));
  auto waiting = std::async(std::launch::async, [this] { return unit(2).await_turn(Time::max()); });
  unit(2).wake();
  EXPECT_EQ(waiting.get(), Transport::Turn::none);
  EXPECT_EQ(unit(2).await_turn(std::chrono::steady_clock::now() + milliseconds(1)), Transport::Turn::none);
  EXPECT_TRUE(unit(1).receive(request));
  ASSERT_EQ(unit(2).await_turn(Time::max()), Transport::Turn::read);
  EXPECT_FALSE(unit(3).reserve());
  EXPECT_TRUE(read(2));
  EXPECT_TRUE(read(3));
}

TEST_F(UnitTransportTest, Who_has_awaited_its_turn_to_write_is_the_next_to_write) {
  connect_all();
  const auto request = WriteRequest::register_value(1, 7);
  ASSERT_TRUE(unit(1).send(request));
  auto waiting = std::async(std::launch::async, [this] { unit(2).await_turn_to_write(); });
  EXPECT_EQ(waiting.wait_for(milliseconds(20)), std::future_status::timeout);
  EXPECT_TRUE(unit(1).receive(request));
  waiting.get();
  EXPECT_FALSE(unit(3).reserve());
  ASSERT_TRUE(unit(2).send(request));
  EXPECT_TRUE(unit(2).receive(request));
  EXPECT_TRUE(read(3));
}

TEST_F(UnitTransportTest, An_interrupt_ends_the_wait_for_a_turn_to_write) {
  connect_all();
  const auto request = WriteRequest::register_value(1, 7);
  ASSERT_TRUE(unit(1).send(request));
  auto waiting = std::async(std::launch::async, [this] { unit(2).await_turn_to_write(); });
  unit(2).interrupt();
  waiting.get();
  EXPECT_FALSE(unit(2).send(request));
  EXPECT_TRUE(unit(1).receive(request));
  EXPECT_TRUE(read(3));
}

TEST_F(UnitTransportTest, A_gateway_that_takes_no_connection_any_more_is_lost_for_all_at_once) {
  const test::LoopbackSocket listener;
  listener.listen(0);  // the kernel takes one connection that nobody accepts
  port = listener.port();
  patience[1] = milliseconds(1000);  // it connects
  patience[2] = milliseconds(200);
  connect_all();
  EXPECT_TRUE(std::holds_alternative<Timeout>(read(1).error()));
  EXPECT_TRUE(std::holds_alternative<NotConnected>(read(2).error()));
  EXPECT_TRUE(std::holds_alternative<TransportFailure>(read(3).error()));
}

TEST_F(UnitTransportTest, An_interrupt_ends_the_wait_for_a_turn) {
  connect_all();
  const auto request = WriteRequest::register_value(1, 7);
  ASSERT_TRUE(unit(1).send(request));
  auto waiting = std::async(std::launch::async, [this] { return read(2); });
  unit(2).interrupt();
  EXPECT_FALSE(waiting.get());
  EXPECT_TRUE(unit(1).receive(request));
  EXPECT_TRUE(read(3));
}

TEST_F(UnitTransportTest, Who_writes_safe_values_has_every_turn_until_they_are_written) {
  connect_all();
  const auto request = WriteRequest::register_value(1, 7);
  ASSERT_TRUE(unit(1).send(request));
  unit(2).rank(Rank::safe);
  auto others = std::async(std::launch::async, [this] { return read(3); });
  EXPECT_TRUE(unit(1).receive(request));
  for (int i = 0; i < 3; ++i) {
    ASSERT_TRUE(unit(2).send(request));
    EXPECT_FALSE(unit(1).reserve());
    EXPECT_TRUE(unit(2).receive(request));
    EXPECT_EQ(others.wait_for(milliseconds(20)), std::future_status::timeout);
  }
  unit(2).rank(Rank::read);
  EXPECT_TRUE(others.get());
}

TEST_F(UnitTransportTest, A_unit_that_modbus_does_not_have_is_told) {
  owned.push_back(make_map(1));
  owned.push_back(make_map(250));
  transports = make_transports({owned[0]->map(), owned[1]->map()});
  ASSERT_TRUE(unit(1).connect());
  EXPECT_EQ(to_string(unit(2).connect().error()), "unit 250 is reserved; Modbus has units 0 to 247 and 255");
}

struct Deaf : Sink {
  void on_bits(const ReadSpan&, Span<const std::uint8_t>, Time) override {}
  void on_registers(const ReadSpan&, Span<const std::uint16_t>, Time) override {}
  void on_online(bool) override {}
  void on_report(Level, const std::string&) override {}
};

struct Tally : WriteListener {
  std::atomic<int> all{0};
  std::atomic<int> ok{0};
  void on_result(const WriteResult& result) override {
    if (result.outcome == WriteResult::Outcome::ok) ++ok;
    ++all;
  }
};

TEST_F(UnitTransportTest, A_write_waits_for_the_request_in_flight_and_for_no_other_read) {
  constexpr int writes = 20;
  make();
  Deaf sink;
  std::vector<std::unique_ptr<DeviceThread>> devices;
  for (std::size_t i = 0; i < units; ++i)
    devices.push_back(
        std::make_unique<DeviceThread>(owned[i]->map(), Verify::off, MapLoader(), *transports[i], sink));
  while (gateway.reads < 10 * units) std::this_thread::sleep_for(milliseconds(10));
  // A write of unit 1 while a read of unit 2 is in flight, which takes so long: its thread has to come
  // meanwhile.
  const auto is_overtaken = [&](milliseconds in_flight) {
    gateway.held = 2;
    while (!gateway.holds) std::this_thread::sleep_for(milliseconds(1));
    const int before = gateway.reads;
    WriteTicket ticket;
    Write write;
    write.listener = &ticket;
    devices[0]->write(write);
    std::this_thread::sleep_for(in_flight);
    gateway.held = -1;
    EXPECT_EQ(ticket.wait().outcome, WriteResult::Outcome::ok);
    return gateway.reads_before_write > before;
  };
  for (int i = 0; i < writes; ++i)
    ASSERT_FALSE(is_overtaken(milliseconds(10)) && is_overtaken(milliseconds(200)) &&
                 is_overtaken(milliseconds(2000)));
}

TEST_F(UnitTransportTest, Every_write_has_one_result_while_all_units_write_and_the_gateway_hangs_up) {
  constexpr int writes = 1000;
  gateway.ends_each = 301;
  make();
  Deaf sink;
  Tally tally;
  std::atomic<int> written{0};
  {
    std::vector<std::unique_ptr<DeviceThread>> devices;
    for (std::size_t i = 0; i < units; ++i)
      devices.push_back(
          std::make_unique<DeviceThread>(owned[i]->map(), Verify::off, MapLoader(), *transports[i], sink));
    std::vector<std::thread> writers;
    writers.reserve(units);
    for (const auto& device : devices)
      writers.emplace_back([&tally, &written, &device] {
        for (int i = 0; i < writes || tally.ok == 0; ++i) {
          Write write;
          write.registers[0] = static_cast<std::uint16_t>(i);
          write.listener = &tally;
          device->write(write);
          ++written;
          if (i % 10 == 0) std::this_thread::sleep_for(milliseconds(3));
        }
      });
    for (std::thread& writer : writers) writer.join();
  }
  EXPECT_EQ(tally.all, written);
  EXPECT_GT(tally.ok, 0);
}

}  // namespace
}  // namespace coupler::host
