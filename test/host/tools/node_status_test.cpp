// SPDX-License-Identifier: Apache-2.0
#include "coupler/tools/node_status.hpp"

#include <gmock/gmock.h>

#include "test/fakes/map_builder.hpp"
#include "test/host/core/fake_device.hpp"

namespace coupler::tools {
namespace {

using host::ExceptionReply;
using host::Timeout;
using host::test::FakeDevice;
using modbus::Exception;
using scan::IdentificationPage;
using testing::ElementsAre;
using testing::IsEmpty;
using testing::Pair;

constexpr auto silence = Timeout{std::chrono::milliseconds(9)};

struct NodeStatusTest : testing::Test {
  NodeStatus look() {
    return read_status(link, [this](modbus::ReadDeviceIdentification) { return identification; });
  }
  void put(std::uint32_t at, std::uint16_t value) {
    device.values[{Table::input_registers, identity::reserved.start() + at}] = value;
  }
  void serve() {
    device.serve(fakes::MapBuilder().coil("a", 0).build()->map());
    put(identity::at_watchdog_state, 2);
    put(16, 42);  // requests
    std::array<std::uint16_t, identity::size> area{};
    identity::write_further({identity::machine_of("cell-7", 7), {}, 0}, area.data());
    for (std::uint32_t at = identity::at_further; at < identity::size; ++at) put(at, area[at]);
  }
  void refuse_identity() { device.missing.insert({Table::input_registers, identity::reserved.start()}); }

  FakeDevice device;
  host::Link link{host::test::share(device), {}, {}};
  host::Result<IdentificationPage> identification = IdentificationPage{{{1, "cell"}}, {}};
};

TEST_F(NodeStatusTest, A_node_tells_all_of_it) {
  serve();
  const NodeStatus status = look();
  EXPECT_FALSE(status.error);
  ASSERT_TRUE(status.report);
  EXPECT_EQ(status.report->watchdog_state, 2);
  EXPECT_EQ(status.report->counts.requests, 42U);
  EXPECT_EQ(hostname_of(status.further.machine), "cell-7");
  EXPECT_THAT(status.identification, ElementsAre(Pair(1, "cell")));
  EXPECT_FALSE(device.connected) << "somebody else may need it";
}

TEST_F(NodeStatusTest, A_node_that_is_older_tells_what_it_has) {
  serve();
  device.missing.insert({Table::input_registers, 0xFF2D});
  const NodeStatus status = look();
  EXPECT_FALSE(status.error);
  EXPECT_TRUE(status.report);
  EXPECT_EQ(status.further.machine.serial, 0U);
}

TEST_F(NodeStatusTest, A_foreign_coupler_tells_its_identification) {
  refuse_identity();
  const NodeStatus status = look();
  EXPECT_FALSE(status.error);
  EXPECT_FALSE(status.report);
  EXPECT_THAT(status.identification, ElementsAre(Pair(1, "cell")));
}

TEST_F(NodeStatusTest, A_foreign_coupler_may_refuse_that_or_ignore_it) {
  refuse_identity();
  const std::vector<host::Error> errors{ExceptionReply{Exception::illegal_function}, silence};
  for (const host::Error& error : errors) {
    identification = tl::make_unexpected(error);
    const NodeStatus status = look();
    EXPECT_FALSE(status.error);
    EXPECT_FALSE(status.report);
    EXPECT_THAT(status.identification, IsEmpty());
  }
}

TEST_F(NodeStatusTest,
       A_coupler_that_ignores_the_question_for_the_area_is_asked_the_rest_over_a_new_connection) {
  device.next_errors = {silence};
  const NodeStatus status = look();
  EXPECT_FALSE(status.error);
  EXPECT_FALSE(status.report);
  EXPECT_THAT(status.identification, ElementsAre(Pair(1, "cell")));
  EXPECT_THAT(device.requests, ElementsAre("connect", "read input_registers 65280+45", "connect"));
}

TEST_F(NodeStatusTest, Who_answers_nothing_is_no_foreign_coupler) {
  device.next_errors = {silence};
  identification = tl::make_unexpected(host::Error(silence));
  EXPECT_EQ(to_string(*look().error), "no reply within 9 ms");
  device.refuse_connect = host::NotConnected{"refused"};
  EXPECT_EQ(to_string(*look().error), "refused");
}

TEST_F(NodeStatusTest, A_unit_that_its_gateway_cannot_reach_is_no_foreign_coupler) {
  const ExceptionReply away{Exception::gateway_target_failed_to_respond};
  device.next_errors = {away};
  EXPECT_EQ(to_string(*look().error), "exception 0B (gateway target failed to respond)");
  refuse_identity();
  identification = tl::make_unexpected(host::Error(away));
  EXPECT_EQ(to_string(*look().error), "exception 0B (gateway target failed to respond)");
}

TEST_F(NodeStatusTest, A_node_that_falls_silent_has_what_it_told_until_then) {
  serve();
  identification = tl::make_unexpected(host::Error(silence));
  const NodeStatus status = look();
  EXPECT_EQ(to_string(*status.error), "no reply within 9 ms");
  EXPECT_EQ(hostname_of(status.further.machine), "cell-7");
}

}  // namespace
}  // namespace coupler::tools
