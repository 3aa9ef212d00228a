// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/scan/scan.hpp"

#include <gmock/gmock.h>

#include "coupler/codec/number.hpp"
#include "coupler/host/scan/draft.hpp"
#include "coupler/host/scan/identification.hpp"
#include "coupler/map/loader/load.hpp"
#include "test/host/scan/foreign_device.hpp"

namespace coupler::scan {
namespace {

using modbus::Range;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Pair;

constexpr Table holding = Table::holding_registers;

class SurveyTest : public testing::Test {
 protected:
  Findings look(std::vector<std::uint8_t> units = {1}) {
    return scan({std::move(units), Range::of(0, 1000), 16, 20}, device_, clock_, onlooker_);
  }
  /// The draft as the loader reads it.
  LoadResult draft(const Findings& findings, const std::vector<Match>& matches = {}) {
    text_ = draft_map(findings, {"10.0.0.7", 1502, findings.unit.value_or(1)}, matches);
    return load_map(text_, "draft.yaml");
  }
  static Match match(std::string_view text, const Findings& findings) {
    const KnownValue known = parse_known_value(text).value();
    return {known, find_candidates(known, findings.tables)};
  }

  test::ForeignDevice device_;
  test::FakeClock clock_;
  test::Onlooker onlooker_;
  std::string text_;
};

TEST_F(SurveyTest, A_device_that_is_not_there_is_told_at_once) {
  device_.refuses_connections = true;
  const Findings findings = look();
  ASSERT_TRUE(findings.broke_off.has_value());
  EXPECT_EQ(device_.connects, 1U);
  EXPECT_EQ(findings.requests, 0U);
}

TEST_F(SurveyTest, The_unit_that_answers_is_surveyed) {
  device_.units = {17};
  device_.fill(holding, 0, 999);
  std::vector<std::uint8_t> units;
  for (std::uint8_t unit = 1; unit <= 20; ++unit) units.push_back(unit);
  const Findings findings = look(units);
  EXPECT_EQ(findings.unit, 17);
  EXPECT_THAT(findings.units, ElementsAre(17));
  EXPECT_TRUE(findings.is_complete);
  EXPECT_THAT(findings.tables[index(holding)].readable(), ElementsAre(Range::of(0, 1000)));
}

TEST_F(SurveyTest, Nobody_there_is_a_complete_survey) {
  device_.units = {};
  const Findings findings = look({1, 2, 3});
  EXPECT_TRUE(findings.is_complete);
  EXPECT_FALSE(findings.unit.has_value());
  EXPECT_EQ(device_.requests, 3U);
}

TEST_F(SurveyTest, An_exception_is_an_answer_unless_a_gateway_gives_it) {
  device_.fails = [](std::size_t request) -> std::optional<host::Error> {
    if (request == 1) return host::ExceptionReply{modbus::Exception::gateway_target_failed_to_respond};
    if (request == 2) return host::ExceptionReply{modbus::Exception::gateway_path_unavailable};
    if (request == 3) return host::ExceptionReply{modbus::Exception::illegal_function};
    return std::nullopt;
  };
  device_.units = {1, 2, 3};
  const Findings findings = look({1, 2, 3});
  EXPECT_THAT(findings.units, ElementsAre(3));
}

TEST_F(SurveyTest, A_unit_that_closes_in_place_of_refusing_is_found_by_another_table) {
  device_.units = {1, 2};
  device_.fill(Table::coils, 0, 9);
  device_.closes_in_place_of_refusing = true;
  EXPECT_THAT(look({1, 2}).units, ElementsAre(1, 2));
}

TEST_F(SurveyTest, The_only_unit_may_be_silent_about_three_tables) {
  device_.fill(Table::discrete_inputs, 0, 9);
  device_.fails = [](std::size_t request) -> std::optional<host::Error> {
    if (request <= 3) return host::Timeout{std::chrono::milliseconds(1000)};
    return std::nullopt;
  };
  EXPECT_THAT(look({1}).units, ElementsAre(1));
}

TEST_F(SurveyTest, Identification_is_read_to_the_end_of_each_stream) {
  device_.identification[1] = {{{{0, "ACME"}}, std::uint8_t{1}}, {{{1, "X1"}, {2, "1.0"}}, std::nullopt}};
  device_.identification[2] = {{{{0, "ACME"}, {4, "Meter"}}, std::nullopt}};
  const Findings findings = look();
  EXPECT_THAT(findings.identification,
              ElementsAre(Pair(0, "ACME"), Pair(1, "X1"), Pair(2, "1.0"), Pair(4, "Meter")));
  EXPECT_EQ(object_name(4), "ProductName");
  EXPECT_EQ(object_name(0x80), "object 80");
}

TEST_F(SurveyTest, A_stream_of_objects_that_goes_round_ends) {
  device_.identification[1] = {{{{0, "ACME"}}, std::uint8_t{0}}};
  EXPECT_THAT(look().identification, ElementsAre(Pair(0, "ACME")));
}

TEST_F(SurveyTest, A_node_of_this_project_is_known_by_its_identity) {
  std::array<std::uint16_t, identity::head_size> area{};
  identity::write_head({42, 7, 9}, area.data());
  for (std::uint32_t i = 0; i < area.size(); ++i)
    device_.values[index(Table::input_registers)][identity::reserved.start() + i] = area[i];
  const Findings findings = look();
  ASSERT_TRUE(findings.node.has_value());
  EXPECT_EQ(findings.node->fingerprint, 42U);
  for (std::size_t late = 2; late <= 6; ++late) {  // one reply; the first one says that the unit is there
    device_.requests = 0;
    device_.fails = [late](std::size_t request) -> std::optional<host::Error> {
      if (request != late) return std::nullopt;
      return host::Timeout{std::chrono::milliseconds(1000)};
    };
    EXPECT_TRUE(look().node.has_value()) << late;
  }
}

TEST_F(SurveyTest, Whoever_ends_it_gets_what_was_found_so_far) {
  device_.fill(Table::coils, 0, 1000);
  device_.fill(holding, 0, 1000);
  device_.before_request = [this] { onlooker_.ends = onlooker_.steps.back() == to_string(holding); };
  const Findings findings = look();
  EXPECT_FALSE(findings.is_complete);
  EXPECT_EQ(findings.unit, 1);
  EXPECT_THAT(findings.tables[0].readable(), ElementsAre(Range::of(0, 1000)));
}

TEST_F(SurveyTest, The_draft_is_a_map_of_all_that_can_be_read_and_nothing_else) {
  device_.fill(Table::coils, 0, 300, 1);
  device_.fill(Table::discrete_inputs, 7, 9);
  device_.fill(Table::input_registers, 0, 250);
  device_.fill(holding, 10, 29);
  device_.fill(holding, 32, 33);
  for (auto& [address, value] : device_.values[index(Table::coils)]) value = address % 2;
  device_.most_registers = 50;
  const Findings findings = look();
  const LoadResult loaded = draft(findings);
  ASSERT_TRUE(loaded.map) << text_;
  EXPECT_TRUE(loaded.diagnostics.empty()) << text_;
  const Map& map = loaded.map->map();
  EXPECT_EQ(map.connection.address, "10.0.0.7");
  EXPECT_EQ(map.limits.read_registers, 50);
  std::array<std::set<std::uint32_t>, 4> mapped;
  for (const Point& point : map.points) {
    EXPECT_EQ(point.access, Access::read);
    for (std::uint32_t i = 0; i < point.count; ++i) mapped[index(point.table)].insert(point.address + i);
  }
  for (const Table table : tables) {
    std::set<std::uint32_t> has;
    for (const auto& [address, value] : device_.values[index(table)]) has.insert(address);
    EXPECT_EQ(mapped[index(table)], has) << to_string(table);
  }
  ASSERT_EQ(map.unreadable.size(), 1U);
  EXPECT_EQ(map.unreadable[0].range, Range::of(30, 2));
}

TEST_F(SurveyTest, Known_values_become_points_of_the_draft) {
  device_.fill(holding, 0, 99);
  std::uint16_t words[4];
  codec::encode(230.4F, codec::Order::CDAB, words);
  codec::encode(70001U, codec::Order::CDAB, words + 2);
  for (std::uint32_t i = 0; i < 4; ++i) device_.values[index(holding)][50 + i] = words[i];
  const Findings findings = look();
  const LoadResult loaded = draft(
      findings, {match("voltage=230.4", findings), match("70001", findings), match("9.87654", findings)});
  ASSERT_TRUE(loaded.map) << text_;
  const Point* voltage = find(loaded.map->map(), "voltage");
  ASSERT_NE(voltage, nullptr) << text_;
  EXPECT_EQ(voltage->address, 50);
  EXPECT_EQ(voltage->format.type, codec::Type::REAL);
  EXPECT_EQ(voltage->format.order, codec::Order::CDAB);
  EXPECT_NE(find(loaded.map->map(), "value_2"), nullptr) << text_;
  EXPECT_EQ(find(loaded.map->map(), "value_3"), nullptr) << text_;
  EXPECT_THAT(text_, HasSubstr("wordorder_reverse: false"));
  EXPECT_THAT(text_, HasSubstr("   # 230.4\n"));
}

TEST_F(SurveyTest, Values_in_different_orders_keep_their_own) {
  device_.fill(holding, 0, 99);
  std::uint16_t words[4];
  codec::encode(230.4F, codec::Order::BADC, words);
  codec::encode(70001U, codec::Order::ABCD, words + 2);
  for (std::uint32_t i = 0; i < 4; ++i) device_.values[index(holding)][50 + i] = words[i];
  const Findings findings = look();
  const LoadResult loaded = draft(findings, {match("a=230.4", findings), match("b=70001", findings)});
  ASSERT_TRUE(loaded.map) << text_;
  EXPECT_EQ(find(loaded.map->map(), "a")->format.order, codec::Order::BADC);
  EXPECT_EQ(find(loaded.map->map(), "b")->format.order, codec::Order::ABCD);
}

TEST_F(SurveyTest, What_a_device_calls_itself_cannot_break_out_of_a_comment) {
  device_.identification[1] = {{{{0, "ACME\nname: other\x1B[2J\xFF"}}, std::nullopt}};
  device_.fill(holding, 0, 3);
  const LoadResult loaded = draft(look());
  ASSERT_TRUE(loaded.map) << text_;
  EXPECT_THAT(text_, HasSubstr("ACME\\x0aname: other\\x1b[2J\\xff"));
}

}  // namespace
}  // namespace coupler::scan
