// SPDX-License-Identifier: Apache-2.0
// Every request needs a right for each point that it touches, and without it is exception 01 as a whole.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "coupler/device/core/server.hpp"
#include "test/device/core/node_under_test.hpp"

namespace coupler::device {
namespace {

using fakes::MapBuilder;
using testing::ElementsAre;

constexpr std::uint32_t rights_epoch = 7;

/// Coils 0 to 3: may be read and written, read, written, nothing; holding registers likewise.
NodeUnderTest four_of_each() {
  return NodeUnderTest(MapBuilder()
                           .coil("c_rw", 0)
                           .coil("c_r", 1)
                           .coil("c_w", 2)
                           .coil("c_none", 3)
                           .holding("h_rw", 0)
                           .holding("h_r", 1)
                           .holding("h_w", 2)
                           .holding("h_none", 3)
                           .everybody_may({"c_rw", "c_r", "h_rw", "h_r"}, {"c_rw", "c_w", "h_rw", "h_w"})
                           .build());
}

Pdu refused(int function) { return {static_cast<std::uint8_t>(0x80 | function), 1}; }

class Rights : public testing::Test {
 protected:
  NodeUnderTest node_{four_of_each().owner};
};

TEST_F(Rights, A_read_needs_the_right_to_read_each_point_of_its_range) {
  for (const int function : {1, 3}) {
    EXPECT_EQ(node_.ask(pdu(function, {0, 2}))[0], function);
    for (const auto& [address, count] : {std::pair(2, 1), std::pair(3, 1), std::pair(1, 2), std::pair(0, 4)})
      EXPECT_EQ(node_.ask(pdu(function, {address, count})), refused(function)) << address;
  }
}

TEST_F(Rights, A_write_needs_the_right_to_write_each_point_of_its_range) {
  EXPECT_EQ(node_.ask(pdu(5, {2, 0xFF00}))[0], 5);
  EXPECT_EQ(node_.ask(pdu(5, {1, 0xFF00})), refused(5));
  EXPECT_EQ(node_.ask(pdu(15, {0, 2}, {1, 3})), refused(15));
  EXPECT_EQ(node_.ask(pdu(6, {0, 7}))[0], 6);
  EXPECT_EQ(node_.ask(pdu(6, {1, 7})), refused(6));
  EXPECT_EQ(node_.ask(pdu(16, {2, 2}, {4, 0, 1, 0, 2})), refused(16));
  EXPECT_EQ(node_.ask(pdu(22, {3, 0, 1})), refused(22));
  const auto cells = node_.image.find(Table::holding_registers, modbus::Range::of(0, 4));
  EXPECT_THAT(std::vector<int>(cells.begin(), cells.end()), ElementsAre(7, 0, 0, 0));
}

TEST_F(Rights, Both_halves_of_a_request_need_theirs) {
  EXPECT_EQ(node_.ask(pdu(23, {1, 1, 2, 1}, {2, 0, 9}))[0], 23);
  EXPECT_EQ(node_.ask(pdu(23, {2, 1, 2, 1}, {2, 0, 9})), refused(23));
  EXPECT_EQ(node_.ask(pdu(23, {1, 1, 1, 1}, {2, 0, 9})), refused(23));
}

TEST_F(Rights, Form_and_address_are_judged_first_values_after) {
  EXPECT_EQ(node_.ask(pdu(1, {3, 2}))[1], 2) << "there is no coil 4";
  EXPECT_EQ(node_.ask(pdu(5, {3, 0x1234}))[1], 3);
  EXPECT_EQ(node_.ask(pdu(1, {3, 0}))[1], 3);
}

TEST_F(Rights, What_shows_all_points_needs_all_rights_to_read) {
  EXPECT_EQ(node_.ask(pdu(4, {0xFF00, 13}))[0], 4);
  EXPECT_EQ(node_.ask(pdu(4, {0xFF00 + 45, 40}))[0], 4);
  EXPECT_EQ(node_.ask(pdu(4, {0xFF00, 14})), refused(4));
  EXPECT_EQ(node_.ask(pdu(20, {}, {7, 6, 0, 1, 0, 0, 0, 1}))[0], 0x80 | 20);
}

TEST(RightsOfBits, A_mask_needs_the_right_for_the_bits_that_it_can_change) {
  const auto bit = [](std::uint8_t n) {
    codec::Format format;
    format.type = codec::Type::BOOL;
    format.bit = n;
    return format;
  };
  NodeUnderTest node(MapBuilder()
                         .holding("low", 0, bit(0))
                         .holding("high", 0, bit(8))
                         .everybody_may({"low"}, {"low"})
                         .build());
  EXPECT_EQ(node.ask(pdu(22, {0, 0xFFFE, 0x0001}))[0], 22);
  EXPECT_EQ(node.ask(pdu(22, {0, 0xFEFF, 0x0100})), refused(22));
  EXPECT_EQ(node.ask(pdu(6, {0, 1})), refused(6)) << "it writes both";
  EXPECT_EQ(node.ask(pdu(3, {0, 1})), refused(3)) << "it shows both";
}

TEST(RightsOfSessions, Each_client_has_those_of_its_role) {
  NodeUnderTest node(MapBuilder().coil("a", 0).everybody_may({"a"}, {}).build());
  ClientSession by_tls;
  by_tls.is_plain = false;
  EXPECT_EQ(node.ask(pdu(1, {0, 1}))[0], 1);
  EXPECT_EQ(node.ask(by_tls, pdu(1, {0, 1})), refused(1)) << "it has no role";
  by_tls.role = node.handler.role_of("everybody");
  EXPECT_EQ(node.ask(by_tls, pdu(1, {0, 1}))[0], 1);
  EXPECT_EQ(node.handler.role_of("nobody"), nullptr);
}

TEST(RightsToSchedule, An_output_at_a_time_needs_the_right_to_write) {
  NodeUnderTest node(
      MapBuilder().coil("open", 0).coil("secret", 1).everybody_may({"open", "secret"}, {"open"}).build());
  node.handler.tell_changes(rights_epoch, node.now);
  const auto schedule = [&](std::uint16_t coil) {
    const modbus::ScheduleOutput when{rights_epoch,
                                      node_time(node.now + std::chrono::milliseconds(5)),
                                      {},
                                      modbus::Function::read_coils,
                                      modbus::Range::of(coil, 1),
                                      {}};
    const std::vector<std::uint16_t> on{1};
    const auto request = modbus::ScheduleRequest::coils(when, on);
    return node.ask(Pdu(request.pdu().begin(), request.pdu().end()));
  };
  EXPECT_EQ(schedule(1), refused(66));
  EXPECT_EQ(schedule(0)[0], 66);
}

TEST(WithoutSecurity, Everybody_may_do_everything) {
  NodeUnderTest node(MapBuilder().coil("a", 0).build());
  EXPECT_EQ(node.ask(pdu(5, {0, 0xFF00}))[0], 5);
  EXPECT_EQ(node.ask(pdu(4, {0xFF00, 46}))[0], 4);
}

}  // namespace
}  // namespace coupler::device
