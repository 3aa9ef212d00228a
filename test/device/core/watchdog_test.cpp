// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "coupler/map/identity.hpp"
#include "test/device/core/node_under_test.hpp"

namespace coupler::device {
namespace {

using fakes::MapBuilder;
using std::chrono::milliseconds;
using testing::ElementsAre;
using testing::ElementsAreArray;
using FedBy = Watchdog::FedBy;
using Recovery = Watchdog::Recovery;

constexpr milliseconds timeout{500};

const Pdu reset = pdu(6, {0xFF00, 0xAA55});
const Pdu any_read = pdu(3, {0, 1});

/// Coils 0 … 3 have lines: safe off, on, off, off; coil 4 is memory.
class GuardedOutputs : public testing::Test {
 protected:
  explicit GuardedOutputs(FedBy fed_by = FedBy::any, Recovery recovery = Recovery::automatic)
      : node_(MapBuilder()
                  .many(Table::coils, 0, 5)
                  .many(Table::discrete_inputs, 0, 1)
                  .many(Table::holding_registers, 0, 2)
                  .watchdog({timeout, fed_by, recovery})
                  .build()) {
    node_.lines.outputs = {{0, {0, 0}}, {1, {1, 0}}, {2, {0, 0}}, {3, {0, 0}}};
  }

  void pass(milliseconds time) {
    node_.now += time;
    node_.handler.tick(node_.now);
  }
  /// State and time left, as a client reads them.
  std::pair<int, int> shown() {
    ClientSession monitor;
    const Pdu reply = node_.ask(monitor, pdu(4, {0xFF00 + identity::at_watchdog_state, 2}));
    return {modbus::get_u16(&reply[2]), modbus::get_u16(&reply[4])};
  }
  int trips() const { return static_cast<int>(node_.statistics.watchdog_trips); }

  const Pdu all_on_ = pdu(15, {0, 5}, {1, 0x1D});  ///< coils 0, 2, 3, 4 on, 1 off
  NodeUnderTest node_;
  ClientSession& client_ = node_.session;
  ClientSession monitor_;
};

TEST_F(GuardedOutputs, Silence_drives_all_of_them_safe_in_one_step_and_the_image_shows_it) {
  node_.ask(all_on_);
  pass(timeout - milliseconds(1));
  EXPECT_EQ(node_.lines.safe_calls, 0);
  pass(milliseconds(1));
  EXPECT_EQ(node_.lines.safe_calls, 1);
  EXPECT_THAT(node_.ask(monitor_, pdu(1, {0, 5})), ElementsAre(1, 1, 0x12)) << "memory keeps its value";
  EXPECT_EQ(trips(), 1);
  pass(10 * timeout);
  EXPECT_EQ(trips(), 1);
}

TEST_F(GuardedOutputs, A_request_that_comes_too_late_finds_them_safe_even_if_nobody_looked_before) {
  node_.ask(all_on_);
  node_.now += timeout;
  EXPECT_THAT(node_.ask(pdu(1, {0, 5})), ElementsAre(1, 1, 0x12));
  EXPECT_EQ(trips(), 1);
}

TEST_F(GuardedOutputs, Nothing_expires_before_an_output_was_written) {
  node_.ask(pdu(5, {4, 0xFF00}));
  node_.ask(pdu(6, {0, 1}));
  node_.lines.broken = true;
  EXPECT_THAT(node_.ask(pdu(5, {0, 0xFF00})), ElementsAre(0x85, 4));
  node_.lines.broken = false;
  pass(10 * timeout);
  EXPECT_EQ(node_.lines.safe_calls, 0);
  EXPECT_EQ(node_.handler.time_until_due(node_.now), std::nullopt);
  EXPECT_EQ(shown(), std::make_pair(1, 0));
}

TEST_F(GuardedOutputs, Requests_of_a_connection_that_has_written_one_keep_them) {
  node_.ask(all_on_);
  for (int i = 0; i < 5; ++i) {
    pass(timeout - milliseconds(1));
    node_.ask(i % 2 == 0 ? any_read : pdu(6, {0, 1}));
  }
  EXPECT_EQ(trips(), 0);
}

TEST_F(GuardedOutputs, Requests_that_are_not_carried_out_do_not_keep_them) {
  node_.ask(all_on_);
  for (int i = 0; i < 4; ++i) {
    pass(timeout / 4);
    node_.ask(pdu(3, {1000, 1}));
    node_.ask(pdu(6, {1000, 1}));
    node_.ask(pdu(90, {}));
  }
  EXPECT_EQ(trips(), 1);
}

TEST_F(GuardedOutputs, Who_writes_something_else_does_not_keep_them) {
  node_.ask(all_on_);
  for (int i = 0; i < 4; ++i) {
    pass(timeout / 4);
    node_.ask(monitor_, pdu(6, {0, 1}));
    node_.ask(monitor_, pdu(5, {4, 0xFF00}));  // a coil without a line
    node_.ask(monitor_, any_read);
  }
  EXPECT_EQ(trips(), 1);
}

TEST_F(GuardedOutputs, A_connection_that_only_reads_does_not_keep_them) {
  node_.ask(all_on_);
  for (int i = 0; i < 3; ++i) {
    pass(timeout / 4);
    node_.ask(monitor_, any_read);
    node_.ask(monitor_, pdu(6, {1000, 1}));  // refused: nothing was written
  }
  pass(timeout / 4);
  EXPECT_EQ(trips(), 1);
}

TEST_F(GuardedOutputs, The_next_write_is_carried_out_and_arms_again) {
  node_.ask(all_on_);
  pass(timeout);
  EXPECT_THAT(node_.ask(pdu(5, {0, 0xFF00})), ElementsAreArray(pdu(5, {0, 0xFF00})));
  EXPECT_EQ(node_.lines.outputs.at(0).level, 1);
  EXPECT_EQ(shown(), std::make_pair(2, 500));
  pass(timeout);
  EXPECT_EQ(trips(), 2);
}

TEST_F(GuardedOutputs, Its_state_and_the_time_left_are_registers) {
  EXPECT_EQ(shown(), std::make_pair(1, 0));
  node_.ask(all_on_);
  pass(milliseconds(123));
  EXPECT_EQ(shown(), std::make_pair(2, 377));
  EXPECT_EQ(node_.handler.time_until_due(node_.now), milliseconds(377));
  pass(timeout);
  EXPECT_EQ(shown(), std::make_pair(3, 0));
}

TEST_F(GuardedOutputs, What_could_not_be_driven_safe_is_tried_again) {
  node_.ask(all_on_);
  node_.lines.broken = true;
  pass(timeout);
  EXPECT_EQ(node_.lines.safe_calls, 1);
  node_.lines.broken = false;
  pass(timeout);
  EXPECT_EQ(node_.lines.outputs.at(0).level, 0);
  pass(10 * timeout);
  EXPECT_EQ(node_.lines.safe_calls, 2);
  EXPECT_EQ(trips(), 1);
}

TEST_F(GuardedOutputs, Without_manual_recovery_the_reset_register_does_not_exist) {
  EXPECT_THAT(node_.ask(reset), ElementsAre(0x86, 2));
  EXPECT_THAT(node_.ask(pdu(3, {0xFF00, 1})), ElementsAre(0x83, 2));
}

class FedByWrites : public GuardedOutputs {
 protected:
  FedByWrites() : GuardedOutputs(FedBy::write) {}
};

TEST_F(FedByWrites, Reads_do_not_keep_them) {
  node_.ask(all_on_);
  pass(timeout / 2);
  node_.ask(any_read);
  node_.ask(pdu(6, {1000, 1}));  // not carried out
  pass(timeout / 2);
  EXPECT_EQ(trips(), 1);
}

TEST_F(FedByWrites, Writes_to_something_else_do_not_keep_them_either) {
  node_.ask(all_on_);
  for (const Pdu& write : {pdu(6, {0, 1}), pdu(16, {0, 1}, {2, 0, 0}), pdu(22, {0, 0, 0}),
                           pdu(23, {0, 1, 0, 1}, {2, 0, 0}), pdu(5, {4, 0})}) {
    pass(timeout / 5);
    node_.ask(write);
  }
  EXPECT_EQ(trips(), 1);
}

TEST_F(FedByWrites, Writes_to_outputs_do) {
  node_.ask(all_on_);
  for (int i = 0; i < 5; ++i) {
    pass(timeout - milliseconds(1));
    node_.ask(i % 2 == 0 ? pdu(5, {0, 0}) : all_on_);
  }
  EXPECT_EQ(trips(), 0);
}

class LockedOutputs : public GuardedOutputs {
 protected:
  LockedOutputs() : GuardedOutputs(FedBy::any, Recovery::manual) {}
  void lock() {
    node_.ask(all_on_);
    pass(timeout);
  }
};

TEST_F(LockedOutputs, Writes_to_them_are_answered_04_until_the_reset) {
  lock();
  EXPECT_THAT(node_.ask(pdu(5, {0, 0xFF00})), ElementsAre(0x85, 4));
  EXPECT_THAT(node_.ask(all_on_), ElementsAre(0x8F, 4));
  EXPECT_THAT(node_.ask(pdu(1, {0, 5})), ElementsAre(1, 1, 0x12));
  EXPECT_EQ(node_.statistics.hardware_errors, 0U);
  EXPECT_THAT(node_.ask(reset), ElementsAreArray(reset));
  EXPECT_EQ(shown(), std::make_pair(1, 0));
  EXPECT_THAT(node_.ask(pdu(5, {0, 0xFF00})), ElementsAreArray(pdu(5, {0, 0xFF00})));
  EXPECT_EQ(shown(), std::make_pair(2, 500));
}

TEST_F(LockedOutputs, Reads_and_what_has_no_line_work_as_ever) {
  lock();
  EXPECT_THAT(node_.ask(pdu(2, {0, 1})), ElementsAre(2, 1, 0));
  EXPECT_THAT(node_.ask(pdu(5, {4, 0})), ElementsAreArray(pdu(5, {4, 0})));
  EXPECT_THAT(node_.ask(pdu(6, {0, 1})), ElementsAreArray(pdu(6, {0, 1})));
  EXPECT_EQ(shown(), std::make_pair(3, 0));
}

TEST_F(LockedOutputs, Only_the_code_resets_in_either_form) {
  lock();
  EXPECT_THAT(node_.ask(pdu(6, {0xFF00, 0xAA56})), ElementsAre(0x86, 3));
  EXPECT_THAT(node_.ask(pdu(16, {0xFF00, 1}, {2, 0, 0})), ElementsAre(0x90, 3));
  EXPECT_EQ(shown().first, 3);
  EXPECT_THAT(node_.ask(pdu(16, {0xFF00, 1}, {2, 0xAA, 0x55})), ElementsAreArray(pdu(16, {0xFF00, 1})));
  EXPECT_EQ(shown().first, 1);
}

TEST_F(LockedOutputs, The_reset_register_is_there_in_every_state_reads_0_and_takes_nothing_else) {
  for (const bool locked : {false, true}) {
    if (locked) lock();
    EXPECT_THAT(node_.ask(monitor_, pdu(3, {0xFF00, 1})), ElementsAre(3, 2, 0, 0));
    EXPECT_THAT(node_.ask(monitor_, pdu(3, {0xFF00, 2})), ElementsAre(0x83, 2));
    EXPECT_THAT(node_.ask(monitor_, pdu(16, {0xFF00, 2}, {4, 0xAA, 0x55, 0, 0})), ElementsAre(0x90, 2));
    EXPECT_THAT(node_.ask(monitor_, pdu(22, {0xFF00, 0, 0xAA55})), ElementsAre(0x96, 2));
    EXPECT_EQ(shown().first, locked ? 3 : 1);
  }
}

TEST_F(LockedOutputs, A_reset_while_armed_changes_nothing) {
  node_.ask(all_on_);
  pass(milliseconds(100));
  node_.ask(monitor_, pdu(3, {0, 1}));
  ClientSession operator_panel;
  node_.ask(operator_panel, reset);
  EXPECT_EQ(shown().first, 2);
}

TEST(WithoutWatchdog, Nothing_ever_happens_and_the_state_is_0) {
  NodeUnderTest node(MapBuilder().many(Table::coils, 0, 1).build());
  node.lines.outputs = {{0, {}}};
  node.ask(pdu(5, {0, 0xFF00}));
  EXPECT_EQ(node.handler.time_until_due(node.now), std::nullopt);
  node.now += std::chrono::hours(10000);
  node.handler.tick(node.now);
  EXPECT_EQ(node.lines.safe_calls, 0);
  EXPECT_THAT(node.ask(pdu(4, {0xFF0B, 2})), ElementsAre(4, 4, 0, 0, 0, 0));
  EXPECT_THAT(node.ask(pdu(3, {0xFF00, 1})), ElementsAre(0x83, 2));
}

}  // namespace
}  // namespace coupler::device
