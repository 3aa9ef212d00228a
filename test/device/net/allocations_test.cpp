// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "test/device/net/counting_heap.hpp"
#include "test/device/net/tcp_under_test.hpp"

namespace coupler::device {
namespace {

using fakes::allocations;

constexpr std::uint32_t epoch = 7;

Pdu wait_for_changes(std::uint32_t of) {
  constexpr std::uint64_t seen = 10;  // all that the requests before it make
  Pdu bytes(modbus::changes_request_size);
  modbus::build_changes_request({30000, of, seen}, bytes);
  return bytes;
}

Pdu schedule_coil() {
  const auto due = node_time(TimePoint::clock::now() + std::chrono::minutes(10));
  const auto request = modbus::ScheduleRequest::coils(
      {epoch, due, {}, modbus::Function::read_coils, modbus::Range::of(0, 1), {}},
      std::vector<std::uint16_t>{1});
  const auto bytes = request.pdu();
  return Pdu(bytes.begin(), bytes.end());
}

const std::vector<Pdu>& every_kind_of_request() {
  static const std::vector<Pdu> requests{
      pdu(1, {0, 2000}),
      pdu(2, {0, 2000}),
      pdu(3, {0, 125}),
      pdu(4, {0xFF00, 25}),
      pdu(5, {0, 0xFF00}),
      pdu(6, {0, 1}),
      pdu(15, {0, 10}, {2, 0xFF, 3}),
      pdu(16, {0, 2}, {4, 0, 0, 0, 0}),
      {20, 7, 6, 0, 1, 0, 0, 0, 100},
      pdu(22, {0, 0, 0}),
      pdu(23, {0, 2, 0, 1}, {2, 0, 0}),
      pdu(3, {60000, 1}),
      pdu(99, {}),
      pdu(5, {0, 1}),
      wait_for_changes(0),      // answered at once
      wait_for_changes(epoch),  // waits, until …
      pdu(5, {1, 0xFF00}),      // … that
      schedule_coil(),
      {66, 1, 2, 0, 0, 0, epoch, 0, 1},  // and cancels it
  };
  return requests;
}

TEST(Allocations, They_are_counted_here) {
  const long before = allocations();
  const Pdu something(100);
  EXPECT_GT(allocations(), before);
}

TEST(Allocations, From_the_socket_to_the_reply_there_is_none) {
  TcpUnderTest node;
  node.node.lines.remembers = false;
  node.node.outcomes.told.reserve(1);
  node.node.handler.tell_changes(epoch, TimePoint::clock::now());
  Client client = node.connect();
  for (const Pdu& request : every_kind_of_request()) {
    const Pdu bytes = adu(1, request);
    const std::uint32_t requests = node.node.statistics.requests;
    client.send(bytes);
    const long before = allocations();
    while (node.node.statistics.requests == requests)
      node.tcp.tick(node.loop.run_once(node.tcp.time_until_due(TimePoint::clock::now())));
    EXPECT_EQ(allocations(), before) << "function " << int{request[0]};
    const bool waits = request == wait_for_changes(epoch);
    EXPECT_EQ((waits ? client.received() : client.awaited()).empty(), waits)
        << "function " << int{request[0]};
  }
  EXPECT_EQ(node.node.outcomes.told.size(), 1U) << "an output was scheduled, and cancelled";
}

TEST(Allocations, Connecting_and_leaving_cost_none) {
  TcpUnderTest node;
  Client first(node.tcp.name());
  const long before = allocations();
  node.settle();
  EXPECT_EQ(allocations(), before);
  first.vanish();
  node.settle();
  EXPECT_EQ(node.tcp.size(), 0U);
  EXPECT_EQ(allocations(), before);
}

TEST(Allocations, Making_room_costs_none) {
  TcpUnderTest node(2);
  Client first = node.connect(1);
  Client second = node.connect(2);
  Client third(node.tcp.name(), 2);
  const long before = allocations();
  node.settle();
  EXPECT_EQ(node.node.statistics.evictions, 1U);
  EXPECT_EQ(allocations(), before);
}

}  // namespace
}  // namespace coupler::device
