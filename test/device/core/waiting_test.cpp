// SPDX-License-Identifier: Apache-2.0
// When a request that waits for changes is answered, as a port sees it: Server and ClientSession.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "coupler/device/core/server.hpp"
#include "test/device/core/node_under_test.hpp"

namespace coupler::device {
namespace {

using fakes::MapBuilder;
using modbus::ChangesReply;
using std::chrono::milliseconds;
using testing::IsEmpty;

class Waiting : public testing::Test {
 protected:
  static constexpr std::uint32_t epoch = 7;
  static constexpr milliseconds timeout{500};

  explicit Waiting(Watchdog::FedBy fed_by = Watchdog::FedBy::any)
      : node_(MapBuilder()
                  .many(Table::coils, 0, 3)
                  .many(Table::discrete_inputs, 0, 3)
                  .watchdog({timeout, fed_by, Watchdog::Recovery::automatic})
                  .build()) {
    node_.lines.outputs = {{0, {0, 0}}};
    node_.handler.tell_changes(epoch, node_.now);
  }

  static Pdu request(int wait, std::uint32_t of = epoch, std::uint64_t seen = 0) {
    Pdu bytes(modbus::changes_request_size);
    modbus::build_changes_request({static_cast<std::uint16_t>(wait), of, seen}, bytes);
    return bytes;
  }
  /// The ADU's bytes that the server writes.
  template <class Answer>
  static Pdu written(Answer answer) {
    Pdu adu(2 * modbus::max_adu_size);
    adu.resize(answer(Span<std::uint8_t>(adu)));
    return adu;
  }
  Pdu send(const Pdu& pdu, std::uint16_t transaction = 1, std::uint8_t unit = 1) {
    return written([&](auto adu) {
      return server_.answer({transaction, unit, pdu}, node_.session, node_.now, adu);
    });
  }
  Pdu told() {
    return written([&](auto adu) { return server_.answer_waiting(node_.session, node_.now, adu); });
  }
  void write(bool level) {
    ClientSession other;
    node_.ask(other, pdu(5, {1, level ? 0xFF00 : 0}));
  }
  static ChangesReply reply(const Pdu& adu) {
    const auto parsed = modbus::parse_changes_reply(modbus::Bytes(adu).from(modbus::mbap_size));
    EXPECT_TRUE(parsed.has_value());
    return parsed.value_or(ChangesReply{});
  }

  NodeUnderTest node_;
  Server server_{1, node_.handler, node_.statistics};
};

TEST_F(Waiting, Lines_that_have_to_be_looked_at_are_though_nobody_asks_for_changes) {
  node_.lines.next = node_.now + milliseconds(5);
  EXPECT_EQ(node_.handler.time_until_due(node_.now), std::nullopt);
  node_.lines.looks = true;
  EXPECT_EQ(node_.handler.time_until_due(node_.now), milliseconds(5));
  node_.lines.changes = {{1, true, node_.now}};
  node_.handler.tick(node_.now);
  EXPECT_THAT(node_.lines.changes, IsEmpty());
}

TEST_F(Waiting, What_was_taken_when_an_edge_woke_the_node_is_not_taken_again_in_that_turn) {
  node_.lines.looks = true;
  node_.handler.take_news(node_.now);
  node_.lines.changes = {{1, true, node_.now}};
  node_.handler.tick(node_.now);
  EXPECT_FALSE(node_.lines.changes.empty());
  node_.handler.tick(node_.now);
  EXPECT_THAT(node_.lines.changes, IsEmpty());
}

TEST_F(Waiting, A_request_with_nothing_to_tell_waits_until_a_change) {
  EXPECT_THAT(send(request(1000), 0xBEEF), IsEmpty());
  EXPECT_TRUE(node_.session.wait.has_value());
  EXPECT_THAT(told(), IsEmpty());
  const TimePoint arrived = node_.now;
  node_.now += milliseconds(10);
  write(true);
  const Pdu adu = told();
  EXPECT_EQ(modbus::get_u16(adu.data()), 0xBEEF);
  EXPECT_EQ(adu[6], 1) << "unit";
  EXPECT_EQ(reply(adu).count, 1);
  EXPECT_EQ(reply(adu).newest, 1U);
  EXPECT_EQ(reply(adu).arrived, arrived.time_since_epoch());
  EXPECT_EQ(reply(adu).replied, node_.now.time_since_epoch());
  EXPECT_FALSE(node_.session.wait.has_value());
  EXPECT_THAT(told(), IsEmpty());
}

TEST_F(Waiting, Or_until_its_time_is_over) {
  send(request(1000));
  node_.now += milliseconds(999);
  EXPECT_THAT(told(), IsEmpty());
  node_.now += milliseconds(1);
  EXPECT_EQ(reply(told()).count, 0);
}

TEST_F(Waiting, Wait_0_is_due_at_once) {
  send(request(0));
  EXPECT_EQ(reply(told()).count, 0);
}

TEST_F(Waiting, A_change_that_is_there_is_due_at_once) {
  write(true);
  send(request(1000));
  EXPECT_EQ(reply(told()).count, 1);
  send(request(1000, epoch, 1));
  EXPECT_THAT(told(), IsEmpty());
}

TEST_F(Waiting, Another_epoch_is_due_at_once_with_the_newest_number_and_no_changes) {
  write(true);
  for (const std::uint32_t of : {0U, epoch + 1}) {
    send(request(1000, of));
    const auto begun = reply(told());
    EXPECT_EQ(begun.epoch, epoch);
    EXPECT_EQ(begun.newest, 1U);
    EXPECT_EQ(begun.count, 0);
  }
}

TEST_F(Waiting, A_further_frame_ends_it_and_both_are_answered_in_order) {
  send(request(1000), 1);
  const Pdu both = send(pdu(1, {0, 3}), 2);
  EXPECT_EQ(modbus::get_u16(&both[0]), 1);
  const std::size_t first = modbus::mbap_size - 1U + modbus::get_u16(&both[4]);
  EXPECT_EQ(modbus::get_u16(&both[first]), 2);
  EXPECT_EQ(both.size(), first + modbus::mbap_size + 3);
}

TEST_F(Waiting, A_second_request_to_wait_is_such_a_frame) {
  send(request(1000), 1);
  const Pdu first = send(request(1000), 2);
  EXPECT_EQ(modbus::get_u16(first.data()), 1);
  EXPECT_EQ(node_.session.wait->transaction, 2);
}

TEST_F(Waiting, So_is_one_for_another_unit) {
  send(request(1000), 1);
  EXPECT_EQ(reply(send(pdu(1, {0, 3}), 2, 9)).count, 0);
  EXPECT_EQ(node_.statistics.foreign_units, 1U);
}

TEST_F(Waiting, It_counts_as_one_request_when_it_comes) {
  send(request(1000));
  EXPECT_EQ(node_.statistics.requests, 1U);
  node_.now += milliseconds(1000);
  told();
  EXPECT_EQ(node_.statistics.requests, 1U);
}

TEST_F(Waiting, What_is_not_allowed_is_exception_03) {
  Pdu long_wait = request(0);
  modbus::put_u16(&long_wait[2], modbus::longest_wait + 1);
  Pdu version = request(0);
  version[1] = 2;
  Pdu cut = request(0);
  cut.pop_back();
  for (const Pdu& wrong : {long_wait, version, cut}) EXPECT_EQ(send(wrong)[8], 3);
  EXPECT_EQ(node_.statistics.exceptions_03, 3U);
}

TEST_F(Waiting, It_feeds_the_watchdog_when_it_comes_and_not_when_it_is_answered) {
  node_.ask(pdu(5, {0, 0xFF00}));
  node_.now += milliseconds(400);
  send(request(1000, epoch, 1));
  EXPECT_EQ(node_.watchdog.left(node_.now), timeout);
  node_.now += milliseconds(400);
  write(true);
  told();
  EXPECT_EQ(node_.watchdog.left(node_.now), milliseconds(100));
}

TEST_F(Waiting, A_client_that_has_written_nothing_feeds_no_watchdog) {
  ClientSession master;
  node_.ask(master, pdu(5, {0, 0xFF00}));
  node_.now += milliseconds(400);
  send(request(1000, epoch, 1));
  EXPECT_EQ(node_.watchdog.left(node_.now), milliseconds(100));
}

struct WaitingWhereWritesFeed : Waiting {
  WaitingWhereWritesFeed() : Waiting(Watchdog::FedBy::write) {}
};

TEST_F(WaitingWhereWritesFeed, It_does_not_feed_the_watchdog) {
  node_.ask(pdu(5, {0, 0xFF00}));
  node_.now += milliseconds(400);
  send(request(1000, epoch, 1));
  EXPECT_EQ(node_.watchdog.left(node_.now), milliseconds(100));
}

TEST_F(Waiting, While_a_client_asks_the_node_turns_when_the_lines_want_it_to) {
  node_.lines.next = node_.now + milliseconds(5);
  EXPECT_EQ(node_.handler.time_until_due(node_.now), std::nullopt) << "nobody asks";
  send(request(1000));
  EXPECT_EQ(node_.handler.time_until_due(node_.now), milliseconds(5));
  node_.lines.next.reset();
  node_.lines.changes = {{0, true, node_.now}};
  node_.handler.tick(node_.now);
  EXPECT_EQ(reply(told()).count, 1);
  node_.lines.next = node_.now + 3 * milliseconds(modbus::longest_wait);
  EXPECT_EQ(node_.handler.time_until_due(node_.now + 2 * milliseconds(modbus::longest_wait)), std::nullopt)
      << "nobody has asked for long";
}

}  // namespace
}  // namespace coupler::device
