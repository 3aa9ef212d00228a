// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <csignal>
#include <utility>

#include "coupler/device/node/io_service.hpp"
#include "test/device/net/tcp_under_test.hpp"

namespace coupler::device {
namespace {

using namespace std::chrono_literals;

using modbus::Change;

/// A simulated node with a coil, and a client of it.
struct Serving : testing::Test {
  Serving() {
    Options options;
    options.simulated = true;
    options.listen = "127.0.0.1";
    options.port = 0;
    auto prepared = ServingContext::prepare(map->map(), nullptr, options, nullptr, nullptr, log);
    EXPECT_TRUE(prepared.has_value());
    context = *std::move(prepared);
    context->wiring = std::exchange(context->prepared, nullptr)->take_over();
  }
  /// Until so many requests were answered, or wait.
  void run_until(IoService& service, std::uint32_t requests) const {
    service.run([&](TimePoint) { return context->state->statistics().requests >= requests; }, [] {});
  }
  static Pdu wait(const modbus::ChangesRequest& request) {
    Pdu bytes(modbus::changes_request_size);
    modbus::build_changes_request(request, bytes);
    return adu(1, bytes);
  }
  static modbus::ChangesReply changes(const Pdu& bytes) {
    const auto reply = modbus::parse_changes_reply(modbus::Bytes(bytes).from(modbus::mbap_size));
    EXPECT_TRUE(reply.has_value());
    return reply.value_or(modbus::ChangesReply{});
  }

  MapPtr map = fakes::MapBuilder().many(Table::coils, 0, 1).build();
  FakeLog log;
  Loop loop;
  std::unique_ptr<ServingContext> context;
};

TEST_F(Serving, Who_waits_for_changes_hears_that_the_outputs_went_to_their_safe_state) {
  IoService service(*context, loop, log);
  Client client(context->listener.name);
  client.send(wait({1000, 0, 0}));
  run_until(service, 1);
  const auto first = changes(client.awaited());
  const std::vector<std::uint16_t> on{1};
  const auto schedule = modbus::ScheduleRequest::coils(
      {first.epoch, first.replied + 1h, 0ms, modbus::Function::read_coils, modbus::Range::of(0, 1), {}}, on);
  client.send(adu(2, Pdu(schedule.pdu().begin(), schedule.pdu().end())));
  run_until(service, 2);
  EXPECT_FALSE(client.awaited().empty());
  client.send(wait({30000, first.epoch, first.newest}));
  run_until(service, 3);
  EXPECT_TRUE(service.make_safe(modbus::Reason::safe_state));
  const auto reply = changes(client.awaited());
  ASSERT_EQ(reply.count, 1);
  EXPECT_EQ(reply.changes[0].kind, Change::Kind::cancelled);
  EXPECT_EQ(reply.changes[0].table, static_cast<std::uint8_t>(modbus::Reason::safe_state));
}

TEST(ShutdownSummary, Of_an_idle_node_is_short) {
  EXPECT_EQ(shutdown_summary("Terminated", true, {}, TimePoint() + 90s),
            "Terminated: outputs are in their safe state; answered 0 requests, 0 of them with an exception; "
            "uptime 90 s");
}

TEST(ShutdownSummary, Has_every_statistic_that_is_not_0_in_one_line) {
  Statistics statistics;
  statistics.started = TimePoint() + 10s;
  statistics.requests = 1000;
  statistics.exceptions = 14;
  statistics.exceptions_01 = 3;
  statistics.exceptions_04 = 11;
  statistics.hardware_errors = 1;
  statistics.events_lost = 2;
  statistics.watchdog_trips = 3;
  statistics.foreign_units = 4;
  statistics.connections = 5;
  statistics.refusals = 6;
  statistics.evictions = 7;
  statistics.bad_frames = 8;
  statistics.timeouts = 9;
  EXPECT_EQ(
      shutdown_summary("Interrupt", false, statistics, TimePoint() + 20s),
      "Interrupt: not every output could be driven to its safe state; answered 1000 requests, 14 of them "
      "with an exception (01: 3, 04: 11); uptime 10 s, connections: 5, refused: 6, evicted: 7, closed for "
      "what they sent: 8, timed out: 9, requests for other units: 4, hardware errors: 1, events lost: 2, "
      "watchdog trips: 3");
}

}  // namespace
}  // namespace coupler::device
