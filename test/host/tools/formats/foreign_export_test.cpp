// SPDX-License-Identifier: Apache-2.0
// What must be told of an export. That the files say the right thing is proved by exports_test.py.
#include <gmock/gmock.h>

#include <set>

#include "coupler/map/loader/load.hpp"
#include "coupler/tools/formats/exporters.hpp"
#include "test/host/tools/formats/imported.hpp"

namespace coupler::test {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

formats::Export exported(std::string_view format, const std::string& points, const std::string& top = "") {
  const LoadResult loaded =
      load_map("{name: m, address: 10.0.0.7, " + top + "mapping: {" + points + "}}", "m");
  EXPECT_NE(loaded.map, nullptr) << lines_of(loaded.diagnostics);
  return loaded.map ? formats::find_exporter(format)->write(loaded.map->map()) : formats::Export{};
}

std::string told(std::string_view format, const std::string& points, const std::string& top = "") {
  return lines_of(exported(format, points, top).warnings.diagnostics("m"));
}

TEST(Export, Every_format_has_a_name_of_its_own_and_is_found_by_it) {
  std::set<std::string_view> names;
  for (const formats::Exporter& exporter : formats::exporters()) {
    EXPECT_TRUE(names.insert(exporter.name).second);
    EXPECT_EQ(formats::find_exporter(exporter.name), &exporter);
  }
  EXPECT_EQ(formats::find_exporter("excel"), nullptr);
}

TEST(Export, The_same_map_gives_the_same_text) {
  for (const formats::Exporter& exporter : formats::exporters())
    EXPECT_EQ(
        exported(exporter.name, "coils: {b: 1, a: 0}, holding_registers: {c: {address: 0, type: REAL}}").text,
        exported(exporter.name, "coils: {b: 1, a: 0}, holding_registers: {c: {address: 0, type: REAL}}")
            .text);
}

TEST(Export, A_loss_of_many_points_is_told_once_with_how_many_they_are) {
  formats::ConversionWarnings warnings;
  for (int i = 0; i < 20; ++i) warnings.add("units are lost", "write them down", "p" + std::to_string(i));
  EXPECT_EQ(lines_of(warnings.diagnostics("m.yaml")),
            "m.yaml: warning: units are lost: p0, p1, p2, p3, p4, p5, p6, p7 and 12 more; write them down\n");
}

TEST(Export, What_writes_the_device_is_told_of_tools_with_two_outputs) {
  const std::string points = "coils: {close: 0, open: 1, suction: 2}";
  const std::string tools =
      "tools: {clamp: {close: close, open: open, travel: 1s}, cup: {close: suction, travel: 1s}}, ";
  for (const char* format : {"home-assistant", "st"})
    EXPECT_THAT(told(format, points, tools),
                HasSubstr("keeps 'close' and 'open' of a tool from being on together: clamp; switch one"))
        << format;
  EXPECT_THAT(told("telegraf", points, tools), Not(HasSubstr("clamp")));
}

TEST(TelegrafExport, What_it_cannot_say_is_told_with_the_points) {
  const std::string points =
      "coils: {c: {address: 0, access: write}}, holding_registers: {a: {address: 1, type: INT, scale: {gain: "
      "2, offset: 5}, rate: 1},"
      "last: {address: 65535, type: INT}, text: {address: 3, type: STRING, length: 4, encoding: latin-1}}";
  EXPECT_THAT(told("telegraf", points), AllOf(HasSubstr("write-only points are left out: c;"),
                                              HasSubstr("the offset of a scale is left out: a;"),
                                              HasSubstr("not at rates of their own: a;"),
                                              HasSubstr("end at address 65535, so they are left out: last;"),
                                              HasSubstr("texts are read as UTF-8: text;")));
  EXPECT_THAT(exported("telegraf", points).text, AllOf(Not(HasSubstr("\"last\"")), Not(HasSubstr("\"c\""))));
}

TEST(TelegrafExport, An_element_of_an_array_gives_way_to_a_point_of_its_name) {
  const std::string points =
      "holding_registers: {pair: {address: 0, type: INT, count: 2}, pair_1: {address: 9, type: INT}}";
  const std::string text = exported("telegraf", points).text;
  for (const char* field : {"address = 0, name = \"pair_0\"", "address = 1, name = \"pair_1_2\"",
                            "address = 9, name = \"pair_1\""})
    EXPECT_THAT(text, HasSubstr(field));
  EXPECT_THAT(told("telegraf", points),
              HasSubstr("names that would be those of other points get a number: pair; rename one"));
}

TEST(TelegrafExport, No_text_turns_the_direction_of_writing) {
  const std::string text =
      exported("telegraf", "coils: {a: {address: 0, description: \"on\u202Effo\"}}").text;
  EXPECT_THAT(text, AllOf(HasSubstr("# on\\u202effo"), Not(HasSubstr("\u202E"))));
}

TEST(TelegrafExport, Unmapped_registers_are_read_only_where_the_map_allows_it) {
  const std::string points = "holding_registers: {a: {address: 1, type: INT}}, coils: {b: 1}";
  EXPECT_THAT(exported("telegraf", points).text, Not(HasSubstr("optimization")));
  const std::string joined = "registers_read_continuous: true, ";
  EXPECT_THAT(exported("telegraf", points, joined).text,
              HasSubstr("register = \"holding\"\n    measurement = \"m\"\n    optimization = \"max_insert\"\n"
                        "    optimization_max_register_fill = 11\n"));
  EXPECT_THAT(
      exported("telegraf", points, joined + "unreadable: [{table: holding_registers, from: 3, to: 4}], ")
          .text,
      Not(HasSubstr("optimization")));
}

TEST(TelegrafExport, The_devices_pauses_and_address_are_carried_over) {
  EXPECT_THAT(exported("telegraf", "coils: {a: 0}",
                       "limits: {request_gap: 5ms, connect_delay: 1s}, port: 1502, rate: 2, ")
                  .text,
              AllOf(HasSubstr("controller = \"tcp://10.0.0.7:1502\""), HasSubstr("interval = \"500ms\""),
                    HasSubstr("pause_after_connect = \"1000ms\"\n    pause_between_requests = \"5ms\"")));
}

TEST(TelegrafExport, An_output_is_read_where_it_reads_back) {
  EXPECT_THAT(exported("telegraf", "coils: {a: {address: 3, read_address: 515}}").text,
              HasSubstr("address = 515, name = \"a\""));
}

TEST(HomeAssistantExport, What_it_cannot_say_is_told_with_the_points) {
  EXPECT_THAT(
      told("home-assistant",
           "holding_registers: {w: {address: 0, type: INT, access: write}, bit: {address: 1, type: BOOL, "
           "bit: 8},"
           "low: {address: 1, type: BOOL, bit: 0, description: hello}, r: {address: 2, type: REAL}}"),
      AllOf(HasSubstr("write-only registers are left out: w;"),
            HasSubstr(
                "only the lowest bit of a register can be a binary sensor, so other bits are left out: bit;"),
            HasSubstr("descriptions are left out: low;"), HasSubstr("floats are rounded to 6 decimals: r;"),
            HasSubstr("which cannot be written: low, bit, r;")));
}

TEST(HomeAssistantExport, A_watchdog_that_its_polls_do_not_feed_is_told) {
  const auto said = [](const std::string& watchdog, const std::string& more = "") {
    const LoadResult loaded = load_map(
        "{name: m, watchdog: " + watchdog + ", mapping: {coils: {lamp: {address: 0" + more + "}}}}", "m");
    EXPECT_NE(loaded.map, nullptr) << lines_of(loaded.diagnostics);
    return lines_of(formats::write_home_assistant(loaded.map->map()).warnings.diagnostics("m"));
  };
  EXPECT_THAT(
      said("{timeout: 500ms}"),
      AllOf(HasSubstr("asks every 5 s, and the node's watchdog takes the outputs that it has switched "
                      "to their safe state after 0.5 s without a request"),
            HasSubstr("write 'watchdog: {timeout: 15s}' into the node's map")));
  EXPECT_THAT(said("{timeout: 15s}"), Not(HasSubstr("watchdog")));
  EXPECT_THAT(said("{timeout: 15s}", ", rate: 0.1"), HasSubstr("write 'watchdog: {timeout: 30s}'"));
  EXPECT_THAT(said("{timeout: 60s, fed_by: write}"), HasSubstr("does not repeat a command"));
  EXPECT_THAT(said("{timeout: 60s}", ", access: write"), HasSubstr("has nothing to read"));
}

TEST(HomeAssistantExport, Names_begin_with_that_of_the_map_and_an_import_takes_it_off) {
  const auto out =
      exported("home-assistant", "coils: {lamp: 0}, input_registers: {level: {address: 1, type: INT}}");
  EXPECT_THAT(out.text, AllOf(HasSubstr("- name: \"m lamp\"\n"), HasSubstr("- name: \"m level\"\n")));
  EXPECT_THAT(out.text, AllOf(HasSubstr("unique_id: m_lamp\n"), HasSubstr("unique_id: m_level\n")));
}

TEST(HomeAssistantExport, No_two_entities_have_one_id) {
  const std::string points =
      "coils: {Lamp: 0, lamp: 1, lamp_2: 2}, discrete_inputs: {arm/left: 0, arm_left: 1}";
  const std::string text = exported("home-assistant", points).text;
  for (const char* id : {"m_lamp\n", "m_lamp_2\n", "m_lamp_2_2\n", "m_arm_left\n", "m_arm_left_2\n"})
    EXPECT_THAT(text, HasSubstr(id)) << text;
  EXPECT_THAT(told("home-assistant", points), HasSubstr("get a number: lamp, lamp_2, arm_left; rename one"));
}

TEST(HomeAssistantExport, A_template_reads_the_sensor_that_gets_the_id) {
  const std::string points =
      "input_registers: {Mode: {address: 0, type: INT, values: {1: a}}, mode: {address: 1, type: INT, "
      "values: "
      "{1: b}}, pair: {address: 2, type: INT, count: 2}, pair_1: {address: 4, type: INT, values: {1: c}}}";
  EXPECT_THAT(exported("home-assistant", points).text,
              AllOf(HasSubstr("{{ {'1': 'a'}.get(states('sensor.m_mode'), states('sensor.m_mode')) }}"),
                    HasSubstr("{{ {'1': 'b'}.get(states('sensor.m_mode_2'), states('sensor.m_mode_2')) }}"),
                    HasSubstr("{{ has_value('sensor.m_pair_1_2') }}")));
  EXPECT_THAT(told("home-assistant", points), HasSubstr("get a number: mode, pair_1, mode; rename one"));
}

TEST(HomeAssistantExport, A_template_that_has_a_sensors_id_is_told) {
  EXPECT_THAT(told("home-assistant",
                   "input_registers: {mode: {address: 0, type: INT, values: {1: a}}, mode_name: {address: 1, "
                   "type: INT}}"),
              HasSubstr("get a number: mode"));
}

TEST(HomeAssistantExport, What_an_import_reads_back_as_another_type_is_told) {
  const std::string said = told(
      "home-assistant",
      "input_registers: {w: {address: 0, type: WORD}, d: {address: 1, type: DWORD}, l: {address: 3, type: "
      "LWORD}, b: {address: 7, type: BYTE, offset: low}, c: {address: 7, type: CHAR, offset: high}, odd: "
      "{address: 8, type: STRING, length: 5}, even: {address: 11, type: STRING, length: 4}, u: {address: "
      "13, type: UINT}}");
  for (const char* each :
       {"an import reads WORD back as UINT: w; keep the map\n", "reads DWORD back as UDINT: d;",
        "reads LWORD back as ULINT: l;", "reads BYTE back as USINT: b;", "reads CHAR back as USINT: c;",
        "texts of odd length have a byte more there: odd; keep that byte 0, which ends the text\n"})
    EXPECT_THAT(said, HasSubstr(each));
}

TEST(HomeAssistantExport, A_swapped_bit_8_is_the_lowest_on_the_wire) {
  EXPECT_THAT(
      exported("home-assistant", "input_registers: {b: {address: 1, type: BOOL, bit: 8, order: BA}}").text,
      HasSubstr("    binary_sensors:\n      - name: \"m b\"\n"));
}

TEST(HomeAssistantExport, Scales_keep_their_decimals_and_slow_points_their_interval) {
  EXPECT_THAT(exported("home-assistant",
                       "input_registers: {a: {address: 1, type: INT, scale: {gain: 0.25, offset: -0.125}, "
                       "units: \"%\", rate: 0.01}}")
                  .text,
              AllOf(HasSubstr("scan_interval: 100\n"),
                    HasSubstr("precision: 3\n        scale: 0.25\n        offset: -0.125\n"
                              "        unit_of_measurement: \"%\"\n")));
}

}  // namespace
}  // namespace coupler::test
