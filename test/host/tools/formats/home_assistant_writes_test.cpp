// SPDX-License-Identifier: Apache-2.0
// With which function codes Home Assistant 2026.2 writes: homeassistant/components/modbus, entity.py
// (BaseSwitch), climate.py and light.py.
#include <gmock/gmock.h>

#include "test/host/tools/formats/imported.hpp"

namespace coupler::test {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

Imported hub_with(const std::string& lists) {
  return Imported("home-assistant",
                  "modbus:\n  - {name: h, type: tcp, host: 10.0.0.7, port: 502, " + lists + "}\n");
}

TEST(HomeAssistantImport, What_is_written_with_code_15_or_16_there_is_so_here) {
  const auto one = [](const std::string& platform, const std::string& type) {
    return hub_with(platform + ": [{name: s, address: 3, verify: {}, write_type: " + type + "}]").text();
  };
  for (const char* platform : {"switches", "lights", "fans"}) {
    EXPECT_THAT(one(platform, "coils"), HasSubstr("s: {address: 3, write_function: multiple}"));
    EXPECT_THAT(one(platform, "holdings"), HasSubstr("}, write_function: multiple}"));
    EXPECT_THAT(one(platform, "coil"), Not(HasSubstr("write_function")));
    EXPECT_THAT(one(platform, "holding"), Not(HasSubstr("write_function")));
  }
  EXPECT_THAT(hub_with("switches: [{name: s, address: 3, write_type: coils}]").text(),
              HasSubstr("s: {address: 3, access: write, write_function: multiple}"));
}

TEST(HomeAssistantImport, A_climates_write_registers_is_of_what_it_stands_for) {
  const auto climate = [](const std::string& keys) {
    return hub_with(
        "climates: [{name: c, address: 1, input_type: input, target_temp_register: 2, "
        "hvac_onoff_register: 3, hvac_mode_register: {address: 4, values: {state_off: 0}" +
        keys + "}]");
  };
  const Imported none = climate("}, write_registers: false");
  EXPECT_THAT(none.text(), Not(HasSubstr("write_function")));
  EXPECT_THAT(none.said, Not(HasSubstr("write_registers")));
  const Imported onoff = climate("}, write_registers: true");
  EXPECT_THAT(onoff.text(),
              AllOf(HasSubstr("c_target: {address: 2, type: INT, units: \"°C\"}\n"),
                    HasSubstr("c_mode: {address: 4, type: UINT, values: {0: \"off\"}}\n"),
                    HasSubstr("c_onoff: {address: 3, type: UINT, values: {0: \"off\", 1: \"on\"}, "
                              "write_function: multiple}\n")));
  EXPECT_THAT(onoff.said, Not(HasSubstr("write_registers")));
  const Imported target = climate("}, target_temp_write_registers: true");
  EXPECT_THAT(target.text(),
              AllOf(HasSubstr("c_target: {address: 2, type: INT, units: \"°C\", write_function: multiple}\n"),
                    HasSubstr("c: {address: 1, type: INT, units: \"°C\"}\n"),
                    HasSubstr("values: {0: \"off\", 1: \"on\"}}\n")));
  EXPECT_THAT(
      climate(", write_registers: yes}").text(),
      AllOf(HasSubstr("c_mode: {address: 4, type: UINT, values: {0: \"off\"}, write_function: multiple}"),
            HasSubstr("values: {0: \"off\", 1: \"on\"}}\n")));
  EXPECT_THAT(climate("}, write_registers: perhaps").said,
              HasSubstr("error: 'write_registers' is neither true nor false"));
}

TEST(HomeAssistantImport, A_mode_whose_address_is_a_list_of_one_is_written_with_code_16) {
  EXPECT_THAT(
      hub_with(
          "climates: [{name: c, address: 1, target_temp_register: 2, fan_mode_register: {address: [44], "
          "values: "
          "{state_fan_low: 1}}, swing_mode_register: {address: [45], values: {swing_mode_state_on: 1}}}]")
          .text(),
      AllOf(HasSubstr("c_fan_mode: {address: 44, type: UINT, values: {1: low}, write_function: multiple}"),
            HasSubstr(
                "c_swing_mode: {address: 45, type: UINT, values: {1: \"on\"}, write_function: multiple}")));
}

TEST(HomeAssistantImport, A_lights_brightness_is_read_and_written_with_code_6_whatever_the_light_is) {
  EXPECT_THAT(
      hub_with("lights: [{name: l, address: 1, write_type: coils, brightness_address: 2, color_temp_address: "
               "3}]")
          .text(),
      AllOf(HasSubstr("l: {address: 1, access: write, write_function: multiple}"),
            HasSubstr("l_brightness: {address: 2, type: UINT, max: 100, units: \"%\"}\n"),
            HasSubstr("l_color_temp: {address: 3, type: UINT, max: 100, units: \"%\"}\n")));
}

TEST(HomeAssistantImport, A_lights_brightness_at_0_is_none) {
  const Imported imported =
      hub_with("lights: [{name: l, address: 1, brightness_address: 0, color_temp_address: 0}]");
  EXPECT_THAT(imported.text(), AllOf(Not(HasSubstr("brightness")), Not(HasSubstr("color_temp"))));
  EXPECT_THAT(imported.said, AllOf(Not(HasSubstr("error")), Not(HasSubstr("_address"))));
}

}  // namespace
}  // namespace coupler::test
