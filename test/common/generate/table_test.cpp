// SPDX-License-Identifier: Apache-2.0
#include "coupler/generate/generate.hpp"

#include <array>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>

#include "test/common/generate/sample.hpp"

namespace coupler::generate {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

std::string source() { return table_source(testing::sample()->map(), testing::provenance); }

TEST(Table, A_coil_is_written_with_its_line_and_initial_state) {
  EXPECT_THAT(source(), HasSubstr(R"(
    // Lamp above the door: coils 3
    {"lamp", Table::coils, 3, {Type::BOOL}, Access::read_write,
     registers<0x0001>, Safe::hold, {"gpiochip0", 17, "", true, Bias::pull_up, Drive::open_drain, 0us},
     "Lamp above the door", ""},
)"));
}

TEST(Table, A_line_is_known_by_its_name_too) {
  EXPECT_THAT(source(), HasSubstr(R"({"", 0, "GPIO4", false, Bias::as_is, Drive::push_pull, 5000us})"));
}

TEST(Table, A_format_names_its_fields_up_to_the_last_that_is_not_the_default) {
  EXPECT_THAT(source(), AllOf(HasSubstr("{Type::REAL, Order::CDAB},"),
                              HasSubstr("{Type::STRING, Order::BADC, Half::high, 0, 3, Encoding::latin1},"),
                              HasSubstr("{Type::BOOL, Order::ABCD, Half::high, 12},")));
}

TEST(Table, A_point_without_a_line_has_none) {
  EXPECT_THAT(source(), HasSubstr("     registers<0x6261, 0x0063>, Safe::off, {},\n"));
}

TEST(Table, The_comment_says_every_address_or_the_bit) {
  EXPECT_THAT(source(),
              AllOf(HasSubstr("// input_registers 100-101\n"), HasSubstr("// holding_registers 7-8\n"),
                    HasSubstr("// holding_registers 9, bit 12\n")));
}

TEST(Table, Bytes_outside_ASCII_are_escaped_in_data) { EXPECT_THAT(source(), HasSubstr(R"("\302\260C"})")); }

TEST(Table, Wires_of_the_simulated_chip_are_rows) {
  EXPECT_THAT(
      source(),
      HasSubstr("    {\"lamp\", \"button\", true, 0us},\n    {\"\", \"button\", false, 1000000us},\n"));
}

TEST(Table, Tools_are_rows) {
  EXPECT_THAT(source(),
              AllOf(HasSubstr("    {\"clamp\", \"lamp\", \"\", \"button\", \"\", \"\", 300ms, 2000ms, "
                              "0ms, true, OnEmpty::abort, false, \"\", {0.04, 0.0}, OnCancel::open},\n"),
                    HasSubstr("    false, tools, axes, 10.0,\n};")));
}

TEST(Table, Axes_are_rows_with_arrays_of_positions_before_them) {
  EXPECT_THAT(
      source(),
      AllOf(HasSubstr("constexpr AxisPosition positions_of_axis_0[] = {\n    {1, -0.5},\n    {0, 0.25},\n};"),
            HasSubstr("constexpr Axis axes[] = {\n    {\"glue\", \"flag\", \"glue_joint\", "
                      "positions_of_axis_0},\n    {\"flow\", \"level\", \"\", {}},\n};")));
}

TEST(Table, Connection_polling_and_limits_are_in_it) {
  EXPECT_THAT(source(), AllOf(HasSubstr(R"({"cell.local", 1502, 7, 250ms, Framing::tcp, {}, {}})"),
                              HasSubstr("{2.5, true, 65, false, 13}"),
                              HasSubstr("{100, 1000, 90, 900, 2ms, 3ms, 4, true, true}")));
}

TEST(Table, Counters_and_latches_follow_the_units) {
  EXPECT_THAT(source(), AllOf(HasSubstr("     \"\", \"\", {}, {\"button\", Edge::both}},\n"),
                              HasSubstr("     \"\", \"\", {\"button\", Edge::falling}, {}},\n")));
}

TEST(Table, Each_of_several_points_at_one_address_names_its_values_in_an_array_of_its_own) {
  OwnedMap owned;
  const NamedValue idle[] = {{0, "idle"}};
  std::vector<Point> points(3);
  for (std::size_t i = 0; i < points.size(); ++i) {
    points[i].name = std::array{"first", "second", "third"}[i];
    points[i].table = Table::holding_registers;
    points[i].format.type = codec::Type::INT;
    points[i].values = idle;
  }
  points[2].access = Access::write;
  owned.finish({}, std::move(points), {});
  const std::string text = table_source(owned.map(), testing::provenance);
  for (int i = 0; i < 3; ++i) {
    EXPECT_THAT(text, HasSubstr(fmt::format("constexpr NamedValue values_of_point_{}[] = {{", i)));
    EXPECT_THAT(text, HasSubstr(fmt::format(", values_of_point_{}, {{}}, {{}}, 0ms", i)));
  }
}

TEST(Table, The_service_is_in_it) {
  EXPECT_THAT(source(),
              AllOf(HasSubstr("    \"10.0.0.7\",\n    \"fd00::/8\",\n"),
                    HasSubstr("{\"::1\", allow, {500ms, Watchdog::FedBy::write, Watchdog::Recovery::manual}, "
                              "true, 502}")));
}

TEST(Table, The_text_is_one_literal_a_line) {
  EXPECT_THAT(source(), HasSubstr("    \"name: cell\\n\"\n    \"rest: \\\"\\303\\274?\\?/\\\\\\\"\";\n"));
}

TEST(Table, A_map_without_points_has_no_empty_arrays) {
  OwnedMap empty;
  empty.finish({}, {}, {});
  EXPECT_THAT(table_source(empty.map(), testing::provenance),
              AllOf(Not(HasSubstr("points[]")), Not(HasSubstr("sim[]")), Not(HasSubstr("tools[]")),
                    Not(HasSubstr("axes[]")), Not(HasSubstr("allow[]")),
                    HasSubstr("    {},\n    {},\n    fingerprint,\n")));
}

TEST(Table, The_header_carries_fingerprint_and_model_version) {
  const auto map = testing::sample();
  const std::string header = table_header(map->map(), testing::provenance);
  EXPECT_THAT(header, AllOf(HasSubstr(fmt::format("fingerprint = 0x{:016x};", map->map().fingerprint)),
                            HasSubstr(fmt::format("model_version == {}", model_version)),
                            HasSubstr("namespace coupler::maps::cell {"),
                            HasSubstr("// cell.yaml as constant data")));
}

TEST(Table, A_file_name_cannot_leave_its_comment) {
  const Provenance odd{"cell", "a\n#error b", "1.2.3"};
  EXPECT_THAT(table_source(testing::sample()->map(), odd), Not(HasSubstr("\n#error")));
}

}  // namespace
}  // namespace coupler::generate
