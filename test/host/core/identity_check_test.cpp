// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/core/identity_check.hpp"

#include <gmock/gmock.h>

#include "test/fakes/map_builder.hpp"
#include "test/host/core/fake_device.hpp"

namespace coupler::host {
namespace {

using fakes::MapBuilder;
using test::FakeDevice;
using testing::ElementsAre;
using testing::HasSubstr;
using Verdict = Identity::Verdict;

struct IdentityCheck : testing::Test {
  IdentityCheck() {
    EXPECT_TRUE(link.connect());
    device.requests.clear();
  }

  /// Checks `known` against a node that serves `served`.
  Identity check(const MapBuilder& known, const MapBuilder& served) {
    const auto here = known.build();
    const auto there = served.build();
    device.serve(there->map());
    return *check_identity(link, here->map(), [&](std::string_view text, std::string_view) {
      EXPECT_EQ(text, there->map().text);
      return LoadResult{there, {}};
    });
  }
  static LoadResult no_map(std::string_view, std::string_view) {
    return {nullptr, {{Diagnostic::Severity::error, "map", 1, 2, "no name", "add one"}}};
  }
  FakeDevice device;
  Link link{test::share(device), {}, {}};
};

TEST_F(IdentityCheck, A_device_that_rejects_the_area_is_foreign) {
  device.missing.insert({Table::input_registers, 0xFF00});
  const auto identity = check_identity(link, MapBuilder().build()->map(), no_map);
  EXPECT_EQ(identity->verdict, Verdict::foreign);
}

TEST_F(IdentityCheck, That_a_foreign_device_refuses_the_question_is_counted_as_an_answer) {
  for (const auto code : {modbus::Exception::illegal_function, modbus::Exception::illegal_data_address,
                          modbus::Exception::illegal_data_value}) {
    device.next_errors.push_back(ExceptionReply{code});
    EXPECT_EQ(check_identity(link, MapBuilder().build()->map(), no_map)->verdict, Verdict::foreign);
    EXPECT_EQ(link.counts().exceptions[static_cast<std::size_t>(code)], 0U);
  }
  EXPECT_EQ(link.counts().requests, 3U);
  std::uint16_t value = 0;
  device.next_errors.push_back(ExceptionReply{modbus::Exception::illegal_data_address});
  EXPECT_FALSE(link.read(Table::input_registers, modbus::Range::of(0, 1), &value));
  EXPECT_EQ(link.counts().exceptions[2], 1U) << "of any other request it is an exception";
}

TEST_F(IdentityCheck, That_a_gateway_cannot_reach_the_unit_is_counted_as_an_exception) {
  device.next_errors.push_back(ExceptionReply{modbus::Exception::gateway_target_failed_to_respond});
  EXPECT_FALSE(check_identity(link, MapBuilder().build()->map(), no_map));
  EXPECT_EQ(link.counts().exceptions[0x0B], 1U);
}

TEST_F(IdentityCheck, A_device_with_other_values_there_is_foreign) {
  device.values[{Table::input_registers, 0xFF00}] = 0x4F43;
  const auto identity = check_identity(link, MapBuilder().build()->map(), no_map);
  EXPECT_EQ(identity->verdict, Verdict::foreign);
}

TEST_F(IdentityCheck, Equal_fingerprints_need_one_request) {
  const auto map = MapBuilder().coil("a", 1);
  EXPECT_EQ(check(map, map).verdict, Verdict::equal);
  EXPECT_THAT(device.requests, ElementsAre("read input_registers 65280+13"));
}

TEST_F(IdentityCheck, A_driver_may_know_a_part_of_the_nodes_points) {
  EXPECT_EQ(check(MapBuilder().coil("a", 1), MapBuilder().coil("a", 1).coil("b", 2)).verdict,
            Verdict::superset);
}

TEST_F(IdentityCheck, A_point_that_moved_is_a_difference) {
  const auto served = MapBuilder().coil("a", 2);
  const Identity identity = check(MapBuilder().coil("a", 1), served);
  EXPECT_EQ(identity.verdict, Verdict::different);
  EXPECT_EQ(identity.fingerprint, served.build()->map().fingerprint);
  EXPECT_THAT(identity.differences, ElementsAre(HasSubstr("a: address 1 -> 2")));
}

TEST_F(IdentityCheck, A_point_that_the_node_does_not_have_is_a_difference) {
  const Identity identity = check(MapBuilder().coil("a", 1).coil("b", 2), MapBuilder().coil("a", 1));
  EXPECT_EQ(identity.verdict, Verdict::different);
  EXPECT_THAT(identity.differences, ElementsAre(HasSubstr("b: missing")));
}

TEST_F(IdentityCheck, A_long_map_is_fetched_piece_by_piece_across_files) {
  auto served = MapBuilder().coil("a", 1).coil("b", 2);
  std::string text(20001, ' ');
  for (std::size_t i = 0; i < text.size(); ++i) text[i] = static_cast<char>('a' + i % 26);
  served.head().text = text;
  EXPECT_EQ(check(MapBuilder().coil("a", 1), served).verdict, Verdict::superset);
  EXPECT_EQ(device.requests.back(), "read file 2 0+1");
}

TEST_F(IdentityCheck, A_map_with_a_wrong_checksum_is_not_believed) {
  device.serve(MapBuilder().text("a: 1").coil("a", 1).build()->map());
  device.file[0] = '?';
  const auto identity = check_identity(link, MapBuilder().build()->map(), no_map);
  EXPECT_EQ(identity->verdict, Verdict::different);
  EXPECT_THAT(identity->differences, ElementsAre(HasSubstr("checksum")));
}

TEST_F(IdentityCheck, A_map_that_does_not_load_is_a_difference_with_its_diagnostics) {
  device.serve(MapBuilder().text("a: 1").coil("a", 1).build()->map());
  const auto identity = check_identity(link, MapBuilder().build()->map(), no_map);
  EXPECT_EQ(identity->verdict, Verdict::different);
  EXPECT_THAT(identity->differences, ElementsAre(HasSubstr("map:1:2: error: no name; add one")));
}

TEST_F(IdentityCheck, A_node_that_does_not_serve_its_map_cannot_be_compared) {
  device.serve(MapBuilder().text("a: 1").coil("a", 1).build()->map());
  device.file.clear();
  const auto identity = check_identity(link, MapBuilder().build()->map(), no_map);
  EXPECT_EQ(identity->verdict, Verdict::different);
  EXPECT_THAT(identity->differences, ElementsAre(HasSubstr("clients that may read every point")));
}

TEST_F(IdentityCheck, A_node_that_is_busy_or_away_when_its_map_is_asked_for_is_asked_again) {
  using modbus::Exception;
  Exception code{};
  device.serve(MapBuilder().text("a: 1").coil("a", 1).build()->map());
  device.refuses = [&](const std::string& request) {
    return request.find("read file") == 0 ? std::optional(code) : std::nullopt;
  };
  for (const Exception passing :
       {Exception::acknowledge, Exception::server_device_busy, Exception::gateway_path_unavailable,
        Exception::gateway_target_failed_to_respond}) {
    code = passing;
    const auto identity = check_identity(link, MapBuilder().build()->map(), no_map);
    ASSERT_FALSE(identity) << modbus::to_string(passing);
    EXPECT_EQ(exception_in(identity.error())->code, passing);
  }
  for (const Exception lasting : {Exception::illegal_function, Exception::illegal_data_address,
                                  Exception::illegal_data_value, Exception::server_device_failure}) {
    code = lasting;
    const auto identity = check_identity(link, MapBuilder().build()->map(), no_map);
    ASSERT_TRUE(identity) << modbus::to_string(lasting);
    EXPECT_EQ(identity->verdict, Verdict::different);
    EXPECT_THAT(identity->differences, ElementsAre(HasSubstr("cannot be compared")));
  }
}

constexpr auto identity_start = identity::reserved.start();

/// What the device has behind the statistics.
void put_machine(FakeDevice& device, const identity::Machine& machine) {
  std::array<std::uint16_t, identity::size> area{};
  identity::write_further({machine, {}, 0}, area.data());
  for (std::uint32_t at = identity::at_further; at < identity::size; ++at)
    device.values[{Table::input_registers, identity_start + at}] = area[at];
}

TEST_F(IdentityCheck, A_node_says_which_machine_it_runs_on) {
  put_machine(device, identity::machine_of("cell-7", 0xAB));
  const auto further = read_further(link);
  ASSERT_TRUE(further);
  EXPECT_EQ(to_string(further->machine), "cell-7, serial 00000000000000ab");
  EXPECT_THAT(device.requests, ElementsAre("read input_registers 65325+1", "read input_registers 65326+39"));
}

TEST_F(IdentityCheck, A_node_that_is_older_than_these_fields_says_nothing) {
  device.missing.insert({Table::input_registers, identity_start + identity::at_further});
  EXPECT_EQ(to_string(read_further(link).value().machine), "");
}

TEST_F(IdentityCheck, Of_a_node_with_fewer_or_more_fields_those_are_read_that_both_know) {
  put_machine(device, identity::machine_of("cell-7", 0xAB));
  auto& count = device.values[{Table::input_registers, identity_start + identity::at_further}];
  count = 4;
  EXPECT_EQ(to_string(read_further(link).value().machine), "serial 00000000000000ab");
  EXPECT_EQ(device.requests.back(), "read input_registers 65326+4");
  count = 0xFFFF;
  EXPECT_EQ(to_string(read_further(link).value().machine), "cell-7, serial 00000000000000ab");
}

TEST_F(IdentityCheck, A_hostname_cannot_command_a_terminal) {
  put_machine(device, identity::machine_of("a\x1b[2J\xff", 0));
  EXPECT_EQ(to_string(read_further(link).value().machine), "a?[2J?");
}

TEST_F(IdentityCheck, A_timeout_is_no_verdict) {
  device.next_errors.assign(1, Timeout{std::chrono::seconds(3)});
  EXPECT_FALSE(check_identity(link, MapBuilder().build()->map(), no_map));
}

}  // namespace
}  // namespace coupler::host
