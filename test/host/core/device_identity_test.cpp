// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>

#include "coupler/map/fingerprint.hpp"
#include "test/host/core/device_fixture.hpp"

namespace coupler::host {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;
using test::DeviceTest;
using testing::ElementsAre;

struct DeviceIdentityTest : DeviceTest {
  static MapBuilder here() { return MapBuilder().coil("a", 1).coil("b", 9); }
  static MapBuilder there() { return MapBuilder().coil("a", 2).coil("b", 9); }
};

TEST_F(DeviceIdentityTest, Equal_maps_are_quiet) {
  serve(here());
  start(here());
  run_for(milliseconds(150));
  EXPECT_THAT(sink->reports, ElementsAre("connected"));
}

TEST_F(DeviceIdentityTest, A_node_that_says_which_machine_it_is_is_named) {
  serve(here());
  std::array<std::uint16_t, identity::size> area{};
  identity::write_further({identity::machine_of("cell-7", 0xAB), {}, 0}, area.data());
  for (std::uint32_t at = identity::at_further; at < identity::size; ++at)
    device.values[{Table::input_registers, identity::reserved.start() + at}] = area[at];
  start(here());
  run_for(milliseconds(150));
  EXPECT_THAT(sink->reports, ElementsAre("connected to cell-7, serial 00000000000000ab"));
  EXPECT_EQ(hostname_of(engine->statistics().machine), "cell-7");
}

TEST_F(DeviceIdentityTest, A_node_that_is_older_is_connected_all_the_same) {
  serve(here());
  device.missing.insert({Table::input_registers, 0xFF2D});
  start(here());
  run_for(milliseconds(150));
  EXPECT_THAT(sink->reports, ElementsAre("connected"));
}

TEST_F(DeviceIdentityTest, A_write_that_a_node_refuses_is_about_rights_and_one_that_another_refuses_is_not) {
  serve(here());
  start(here());
  run_for(milliseconds(150));
  device.next_errors.push_back(ExceptionReply{modbus::Exception::illegal_function});
  push("a", 1);
  engine->step();
  EXPECT_EQ(sink->reported("write to a: exception 01 (illegal function): this client has no right to"), 1);
  device.values.clear();
  device.missing.insert({Table::input_registers, 0xFF00});
  start(here());
  run_for(milliseconds(150));
  device.next_errors.push_back(ExceptionReply{modbus::Exception::illegal_function});
  push("a", 1);
  engine->step();
  EXPECT_EQ(sink->reported("write to a: exception 01"), 1) << "start() begins a new list";
  EXPECT_EQ(sink->reported("no right"), 0);
}

TEST_F(DeviceIdentityTest, A_foreign_coupler_is_quiet) {
  device.missing.insert({Table::input_registers, 0xFF00});
  start(here());
  run_for(milliseconds(150));
  EXPECT_THAT(sink->reports, ElementsAre("connected"));
  EXPECT_EQ(sink->values["a"].size(), 2U);
}

TEST_F(DeviceIdentityTest, A_device_that_is_silent_about_its_identity_is_told_once_with_the_remedy) {
  start(here());
  for (int i = 0; i < 4; ++i) device.next_errors.push_back(Timeout{milliseconds(3000)});
  run_for(milliseconds(1200));
  EXPECT_EQ(sink->reported("--verify off"), 1);
  EXPECT_TRUE(sink->online.empty());
  run_for(seconds(6));
  EXPECT_THAT(sink->online, ElementsAre(true));
}

TEST_F(DeviceIdentityTest, A_unit_that_a_gateway_never_reached_is_told_as_such_with_both_remedies) {
  start(here());
  for (int i = 0; i < 4; ++i)
    device.next_errors.push_back(ExceptionReply{modbus::Exception::gateway_target_failed_to_respond});
  run_for(milliseconds(1200));
  EXPECT_EQ(sink->reported("the gateway answers, but unit 1 does not answer"), 1);
  EXPECT_EQ(sink->reported("'unit' is its unit id"), 1);
  EXPECT_EQ(sink->reported("--verify off"), 1);
  EXPECT_EQ(sink->reported("the gateway cannot reach unit 1: exception 0B"), 1);
  EXPECT_EQ(sink->reported("not connected"), 0);
}

TEST_F(DeviceIdentityTest, Who_has_answered_once_is_not_taken_for_one_who_ignores_the_question) {
  const std::vector<Error> troubles{Timeout{milliseconds(3000)},
                                    ExceptionReply{modbus::Exception::gateway_path_unavailable}};
  serve(here());
  for (const Error& trouble : troubles) {
    device.next_errors.clear();
    start(here());
    run_for(milliseconds(150));
    for (int i = 0; i < 6; ++i) device.next_errors.push_back(trouble);
    run_for(seconds(3));
    const bool by_gateway = is_unit_away(trouble);
    EXPECT_EQ(sink->reported("--verify off"), 0);
    EXPECT_EQ(sink->reported("the gateway cannot reach unit 1: exception 0A"), by_gateway ? 1 : 0);
    EXPECT_EQ(sink->reported("connection lost"), by_gateway ? 0 : 1);
  }
}

TEST_F(DeviceIdentityTest, A_different_map_is_neither_read_nor_written) {
  serve(there());
  start(here());
  run_for(milliseconds(50));
  push("b", 1);
  run_for(seconds(20));
  EXPECT_TRUE(sink->values.empty());
  EXPECT_EQ(device.count("write coil 9"), 0U);
  EXPECT_TRUE(sink->online.empty());
  EXPECT_FALSE(device.connected) << "the connection may be the only one the device has";
}

TEST_F(DeviceIdentityTest, Both_fingerprints_and_the_points_that_differ_are_reported_once) {
  serve(there());
  start(here());
  run_for(seconds(20));
  EXPECT_EQ(sink->reported("~ a: address 1 -> 2"), 1);
  EXPECT_EQ(sink->reported(fingerprint_text(owned->map().fingerprint)), 1);
  EXPECT_EQ(sink->reported(fingerprint_text(served->map().fingerprint)), 1);
  EXPECT_EQ(sink->reported("b:"), 0);
}

TEST_F(DeviceIdentityTest, A_device_that_gets_the_right_map_is_taken_without_a_restart) {
  serve(there());
  start(here());
  run_for(seconds(2));
  serve(here());
  run_for(seconds(6));
  EXPECT_THAT(sink->online, ElementsAre(true));
}

TEST_F(DeviceIdentityTest, A_device_with_more_points_is_read_and_written) {
  serve(here().coil("c", 20));
  start(here());
  run_for(milliseconds(50));
  push("b", 1);
  run_for(milliseconds(1));
  EXPECT_EQ(sink->values["a"].size(), 1U);
  EXPECT_EQ((device.values[{Table::coils, 9}]), 1);
}

TEST_F(DeviceIdentityTest, With_warn_a_different_map_is_reported_and_used) {
  serve(there());
  start(here(), Verify::warn);
  run_for(milliseconds(150));
  EXPECT_EQ(sink->reported("~ a: address 1 -> 2"), 1);
  EXPECT_EQ(sink->values["a"].size(), 2U);
}

TEST_F(DeviceIdentityTest, With_off_nobody_asks) {
  serve(there());
  start(here(), Verify::off);
  run_for(milliseconds(150));
  EXPECT_THAT(sink->reports, ElementsAre("connected"));
  EXPECT_EQ(device.count("read input_registers 65280+13"), 0U);
}

}  // namespace
}  // namespace coupler::host
