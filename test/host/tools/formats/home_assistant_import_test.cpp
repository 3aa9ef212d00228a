// SPDX-License-Identifier: Apache-2.0
// The keys, their defaults and what they mean are those of Home Assistant's modbus integration 2026.2:
// homeassistant/components/modbus (schemas in __init__.py, validators.py, entity.py) and its documentation.
#include <gmock/gmock.h>

#include "coupler/map/loader/load.hpp"
#include "coupler/tools/formats/exporters.hpp"
#include "test/host/tools/formats/imported.hpp"

namespace coupler::test {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

/// A hub with these lists of entities.
Imported hub(const std::string& lists, const std::string& keys = "") {
  return Imported("home-assistant",
                  "modbus:\n  - {name: h, type: tcp, host: 10.0.0.7, port: 502, " + keys + lists + "}\n");
}

TEST(HomeAssistantImport, A_hub_is_where_the_device_is_and_how_it_is_treated) {
  const Imported imported("home-assistant", R"(modbus:
  - name: "hub1"
    type: tcp
    host: 192.168.1.1
    port: 1502
    timeout: 5
    delay: 2
    message_wait_milliseconds: 30
    binary_sensors:
      - name: door
        address: 110
        slave: 7
        input_type: discrete_input
)");
  EXPECT_EQ(imported.text(),
            "name: hub1\naddress: 192.168.1.1\nport: 1502\nunit: 7\ntimeout: 5\nrate: 0.06667\n"
            "limits: {connect_delay: 2s, request_gap: 30ms}\n"
            "mapping:\n  discrete_inputs:\n    door: 110\n");
  EXPECT_EQ(imported.said, "");
}

TEST(HomeAssistantImport, The_hubs_name_is_taken_off_names_that_all_begin_with_it) {
  EXPECT_THAT(hub("switches: [{name: h lamp, address: 3}], sensors: {name: h h level, address: 4}").text(),
              AllOf(HasSubstr("    lamp: "), HasSubstr("    h_level: ")));
  EXPECT_THAT(hub("switches: [{name: h lamp, address: 3}, {name: horn, address: 4}]").text(),
              AllOf(HasSubstr("    h_lamp: "), HasSubstr("    horn: ")));
}

TEST(HomeAssistantImport, A_timeout_may_be_a_fraction_and_is_no_longer_than_a_map_takes) {
  const std::string sensors = "sensors: [{name: s, address: 3}]";
  EXPECT_THAT(hub(sensors, "timeout: 0.5, ").text(), HasSubstr("timeout: 0.5\n"));
  EXPECT_THAT(hub(sensors, "timeout: 90, ").text(), HasSubstr("timeout: 60\n"));
  EXPECT_THAT(hub(sensors, "timeout: 90, ").said, HasSubstr("a timeout of 90 s is read as 60 s"));
}

TEST(HomeAssistantImport, Of_a_whole_configuration_only_modbus_is_read) {
  const Imported imported("home-assistant", R"(default_config:
automation: !include automations.yaml
template: &all
  - sensor: [{name: x, state: "{{ 1 }}"}]
other: *all
modbus:
- type: tcp
  host: plc
  port: 502
  # and the rest
  sensors:
  - {name: level, address: 0, input_type: input}
homeassistant: !secret everything
)");
  EXPECT_THAT(imported.text(),
              HasSubstr("address: plc\nport: 502\nunit: 1\nrate: 0.06667\n"
                        "mapping:\n  input_registers:\n    level: {address: 0, type: INT}\n"));
}

TEST(HomeAssistantImport, The_list_of_hubs_may_be_a_file_of_its_own) {
  const std::string list =
      "- {type: tcp, host: plc, port: 502, name: h, binary_sensors: {name: a, address: 1}}\n";
  EXPECT_EQ(Imported("home-assistant", list).text(), Imported("home-assistant", "modbus:\n" + list).text());
  EXPECT_EQ(Imported("home-assistant", list.substr(2)).text(), Imported("home-assistant", list).text());
}

TEST(HomeAssistantImport, A_secret_is_left_out_and_an_included_file_is_asked_for) {
  const Imported secret("home-assistant",
                        "modbus:\n  - type: tcp\n    host: !secret plc # which one\n    port: 502\n"
                        "    switches: [{name: \"a!b\", address: 1, write_type: coil, verify: }]\n");
  EXPECT_THAT(secret.said, HasSubstr("given:3:11: warning: 'host' is a secret, which is not read"));
  EXPECT_THAT(secret.text(), AllOf(Not(HasSubstr("address: plc")), HasSubstr("description: \"a!b\"")));
  EXPECT_THAT(
      Imported("home-assistant", "modbus: !include modbus.yaml\n").said,
      HasSubstr("given:1:9: error: 'modbus' stands in another file; give that file, or put its text"));
  EXPECT_THAT(Imported("home-assistant", "modbus:\n- type: tcp\n  sensors: !include_dir_list sensors\n").said,
              HasSubstr("given:3:12: error: 'sensors' stands in another file"));
  EXPECT_THAT(Imported("home-assistant", "modbus:\n- type: tcp\n  port: !env_var P\n").said,
              HasSubstr("error: the tag '!env_var' of 'port' is not known"));
}

TEST(HomeAssistantImport, One_of_several_hubs_is_chosen_by_its_name) {
  const std::string text =
      "modbus:\n  - {name: a, type: tcp, host: x, port: 1, sensors: [{name: s, address: 0}]}\n"
      "  - {name: b, type: tcp, host: y, port: 2, sensors: [{name: s, address: 0}]}\n";
  EXPECT_THAT(Imported("home-assistant", text).said,
              HasSubstr("error: the file has several hubs: a, b; give one of them with --device: a, b"));
  formats::ImportOptions options;
  options.device = "b";
  EXPECT_THAT(Imported("home-assistant", text, options).text(), HasSubstr("name: b\naddress: y\nport: 2\n"));
  options.device = "c";
  EXPECT_THAT(Imported("home-assistant", text, options).said,
              HasSubstr("error: there is no hub 'c' in the file"));
}

TEST(HomeAssistantImport, Each_slave_is_a_map_of_its_own) {
  const Imported both =
      hub("binary_sensors: [{name: a, address: 1, slave: 2}, {name: b, address: 1, device_address: 3}, "
          "{name: c, address: 4, slave: 2}]");
  ASSERT_EQ(both.result.maps.size(), 2U);
  EXPECT_THAT(both.text(0), AllOf(HasSubstr("name: h_2\n"), HasSubstr("unit: 2\n"), HasSubstr(" c: ")));
  EXPECT_THAT(both.text(1), AllOf(HasSubstr("name: h_3\n"), HasSubstr("unit: 3\n"), Not(HasSubstr(" c: "))));
}

TEST(HomeAssistantImport, What_is_only_read_there_is_only_read_here) {
  const Imported imported =
      hub("sensors: [{name: s, address: 3}], binary_sensors: [{name: c, address: 1}, "
          "{name: b, address: 9, input_type: holding, virtual_count: 1}]");
  EXPECT_THAT(imported.text(), AllOf(HasSubstr("s: {address: 3, type: INT, access: read}"),
                                     HasSubstr("c: {address: 1, access: read}"),
                                     HasSubstr("b_0: {address: 9, type: BOOL, bit: 0, access: read}\n"
                                               "    b_1: {address: 10, type: BOOL, bit: 0, access: read}")));
  EXPECT_THAT(imported.said, HasSubstr("so these points get 'access: read': c, b, s; remove it where"));
}

TEST(HomeAssistantImport, A_switch_is_read_back_where_it_is_verified) {
  const auto one = [](const std::string& keys) {
    return hub("switches: [{name: s, address: 3, " + keys + "}]");
  };
  EXPECT_THAT(one("write_type: coil").text(), HasSubstr("s: {address: 3, access: write}"));
  EXPECT_THAT(one("write_type: coil").said, HasSubstr("without 'verify' the output is only written"));
  EXPECT_THAT(one("write_type: coil, verify: ").text(), HasSubstr("coils:\n    s: 3\n"));
  EXPECT_THAT(one("write_type: coil, verify: {address: 9, delay: 1}").text(),
              HasSubstr("s: {address: 3, read_address: 9}"));
  EXPECT_THAT(one("write_type: coil, verify: {input_type: discrete_input, address: 9}").text(),
              HasSubstr("coils:\n    s: {address: 3, access: write}\n  discrete_inputs:\n    s_state: 9\n"));
  EXPECT_THAT(one("verify: {}").text(),
              HasSubstr("s: {address: 3, type: UINT, values: {0: \"off\", 1: \"on\"}}"));
  EXPECT_THAT(
      one("command_on: 7, command_off: 2, verify: {input_type: input, state_on: [8, 9]}").text(),
      HasSubstr("input_registers:\n    s_state: {address: 3, type: UINT, values: {2: \"off\", 8: \"on\", 9: "
                "on_2}}\n"
                "  holding_registers:\n    s: {address: 3, type: UINT, values: {2: \"off\", 7: \"on\"}, "
                "access: write}\n"));
  EXPECT_THAT(one("write_type: coil, command_on: 0, command_off: 1").said,
              HasSubstr("Home Assistant switches these on by writing 0"));
}

TEST(HomeAssistantImport, Lights_fans_and_covers_are_their_registers) {
  EXPECT_THAT(
      hub("lights: [{name: l, address: 1, verify: {}, brightness_address: 2}], fans: [{name: f, address: 5, "
          "write_type: coil, verify: {}}]")
          .text(),
      AllOf(HasSubstr("l_brightness: {address: 2, type: UINT, max: 100, units: \"%\"}"),
            HasSubstr("f: 5\n")));
  EXPECT_THAT(hub("covers: [{name: c, address: 1}]").text(),
              HasSubstr("c: {address: 1, type: UINT, values: {0: closed, 1: open, 2: opening, 3: closing}}"));
  EXPECT_THAT(hub("covers: [{name: c, address: 1, input_type: coil}]").text(),
              HasSubstr("coils:\n    c: 1\n"));
  EXPECT_THAT(
      hub("covers: [{name: c, address: 1, status_register: 4, status_register_type: input}]").text(),
      AllOf(HasSubstr(
                "c_status: {address: 4, type: UINT, values: {0: closed, 1: open, 2: opening, 3: closing}}"),
            HasSubstr("c: {address: 1, type: UINT, values: {0: closed, 1: open}, access: write}")));
}

TEST(HomeAssistantImport, A_climate_is_its_temperatures_and_modes) {
  const Imported imported =
      hub(R"(climates: [{name: c, address: 1, input_type: input, scale: 0.1, target_temp_register: 2,
    hvac_mode_register: {address: 3, values: {state_off: 0, state_heat: [1, 4]}},
    hvac_action_register: {address: 4, input_type: input, values: {action_idle: 0}},
    fan_mode_register: {address: 5, values: {state_fan_low: 1}},
    swing_mode_register: {address: 6, values: {swing_mode_state_on: 1}},
    hvac_onoff_coil: 7, max_temp: 30}])");
  EXPECT_THAT(imported.text(),
              HasSubstr("  coils:\n    c_onoff: 7\n"
                        "  input_registers:\n"
                        "    c: {address: 1, type: INT, scale: 0.1, units: \"°C\"}\n"
                        "    c_action: {address: 4, type: UINT, values: {0: idle}}\n"
                        "  holding_registers:\n"
                        "    c_target: {address: 2, type: INT, scale: 0.1, units: \"°C\"}\n"
                        "    c_mode: {address: 3, type: UINT, values: {0: \"off\", 1: heat, 4: heat_2}}\n"
                        "    c_fan_mode: {address: 5, type: UINT, values: {1: low}}\n"
                        "    c_swing_mode: {address: 6, type: UINT, values: {1: \"on\"}}\n"));
  EXPECT_THAT(imported.said, HasSubstr("'max_temp' is not carried over: c; give the target's point"));
  EXPECT_THAT(hub("climates: [{name: c, address: 1, target_temp_register: [2, 3, 2, 2, 4, 2, 2]}]").text(),
              AllOf(HasSubstr("c_target_auto: {address: 2,"), HasSubstr("c_target_cool: {address: 3,"),
                    HasSubstr("c_target_heat: {address: 4,")));
}

TEST(HomeAssistantImport, The_first_of_two_entities_has_the_place_and_what_writes_is_first) {
  const Imported imported =
      hub("sensors: [{name: whole, address: 3, data_type: uint32, input_type: holding}], "
          "switches: [{name: s, address: 4, verify: {}}]");
  EXPECT_THAT(imported.text(), Not(HasSubstr("whole")));
  EXPECT_THAT(imported.said,
              HasSubstr("warning: 'whole' is at the same place as 's' in line 2, so it is left out"));
  EXPECT_THAT(
      hub("sensors: [{name: r, address: 3}], switches: [{name: w, address: 3}]").text(),
      AllOf(HasSubstr("r: {address: 3, type: INT, access: read}"), HasSubstr("w: {address: 3, type: UINT,")));
}

TEST(HomeAssistantImport, Of_two_entities_that_only_read_the_first_in_the_file_has_the_place) {
  const Imported imported = hub(R"(sensors: [{name: Probe, address: 2, input_type: input, nan_value: 0x7FFF,
    scan_interval: 1}], climates: [{name: Chamber, address: 2, input_type: input, scale: 0.1,
    target_temp_register: 3}])");
  EXPECT_THAT(imported.text(), HasSubstr("Probe: {address: 2, type: INT, invalid: 0x7FFF}"));
  EXPECT_THAT(imported.text(), HasSubstr("rate: 1\n"));
  EXPECT_THAT(imported.said, HasSubstr("'Chamber' is at the same place as 'Probe' in line 2, so it is left "
                                       "out; lost: 'scale', 'units'; a map has one point"));
}

TEST(HomeAssistantImport, The_entity_that_stays_takes_over_what_says_nothing_else) {
  const Imported imported = hub(R"(climates: [{name: Chamber, address: 2, input_type: input, scale: 0.1}],
    sensors: [{name: Probe, address: 2, input_type: input, nan_value: 0x7FFF, scan_interval: 1}])");
  EXPECT_THAT(imported.text(),
              HasSubstr("Chamber: {address: 2, type: INT, scale: 0.1, units: \"°C\", invalid: 0x7FFF}"));
  EXPECT_THAT(imported.text(), HasSubstr("rate: 1\n"));
  EXPECT_THAT(imported.said,
              HasSubstr("'Probe' is at the same place as 'Chamber' in line 2, so it is left out; 'Chamber' "
                        "takes over 'invalid', 'scan_interval: 1'; lost: that it has no 'scale'; a map"));

  const Imported written =
      hub("sensors: [{name: s, address: 3, scan_interval: 2, nan_value: 9}], "
          "covers: [{name: c, address: 3}]");
  EXPECT_THAT(written.text(), AllOf(HasSubstr("rate: 0.5\n"), HasSubstr("c: {address: 3, type: UINT")));
  EXPECT_THAT(written.said,
              HasSubstr("so it is left out; 'c' takes over 'scan_interval: 2'; lost: 'invalid', "
                        "its type or size;"));
}

TEST(HomeAssistantImport, An_entity_with_a_scale_takes_over_no_names_of_values) {
  const std::string climate = R"(climates: [{name: c, address: 9, target_temp_register: 8,
    hvac_action_register: {address: 3, input_type: input, values: {action_idle: 0}}}])";
  const std::string sensor = "sensors: [{name: s, address: 3, input_type: input, data_type: uint16";
  const Imported scaled = hub(sensor + ", scale: 0.1}], " + climate);
  EXPECT_THAT(scaled.text(), HasSubstr("s: {address: 3, type: UINT, scale: 0.1}"));
  EXPECT_THAT(scaled.said, HasSubstr("so it is left out; lost: 'values', that it has no 'scale'; a map"));
  const Imported plain = hub(sensor + "}], " + climate);
  EXPECT_THAT(plain.text(), HasSubstr("s: {address: 3, type: UINT, values: {0: idle}}"));
  EXPECT_THAT(plain.said, HasSubstr("'s' takes over 'values'"));
}

TEST(HomeAssistantImport, What_is_not_carried_over_is_told_at_the_first_entitys_key) {
  const Imported imported = hub(R"(sensors: [{name: a, address: 1,
    device_class: x, max_value: 9}, {name: b, address: 2, max_value: 9}],
    climates: [{name: Chamber, address: 2, target_temp_register: 3,
    min_temp: 5}])");
  EXPECT_THAT(imported.said, HasSubstr("5:5: warning: 'min_temp' is not carried over: Chamber"));
  EXPECT_THAT(imported.said, HasSubstr("3:5: warning: 'device_class' belongs to Home Assistant"));
  EXPECT_THAT(imported.said,
              HasSubstr("3:22: warning: 'max_value' changes what Home Assistant shows and is not "
                        "carried over: a, b"));
  EXPECT_THAT(imported.said, Not(HasSubstr("2:5: warning")));
}

TEST(HomeAssistantImport, The_fastest_interval_is_the_maps_rate) {
  const Imported imported =
      hub("binary_sensors: [{name: a, address: 1, scan_interval: 5}, {name: b, address: 2, "
          "scan_interval: 20}, {name: c, address: 3, scan_interval: 0}]");
  EXPECT_THAT(imported.text(), AllOf(HasSubstr("rate: 0.2\n"), HasSubstr("a: {address: 1, access: read}"),
                                     HasSubstr("b: {address: 2, access: read, rate: 0.05}")));
  EXPECT_THAT(imported.said, HasSubstr("('scan_interval: 0') is read at the map's rate: c;"));
}

TEST(HomeAssistantImport, A_nan_value_is_what_the_map_calls_invalid) {
  const Imported imported =
      hub("sensors: [{name: s, address: 3, data_type: int16, nan_value: 0x8000}, {name: t, address: 4, "
          "data_type: uint32, "
          "nan_value: \"0xFFFFFFFF\"}]");
  EXPECT_THAT(imported.text(), AllOf(HasSubstr("invalid: 0x8000"), HasSubstr("invalid: 0xFFFFFFFF")));
  EXPECT_THAT(imported.said, Not(HasSubstr("nan_value")));
}

TEST(HomeAssistantImport, What_a_map_has_no_key_for_is_told) {
  const Imported imported =
      hub("sensors: [{name: s, address: 3, unique_id: x, max_value: 9, min_value: 2, colour: red}]",
          "retries: 3, ");
  EXPECT_THAT(imported.said,
              AllOf(HasSubstr("'unique_id' belongs to Home Assistant and is not carried over: s;"),
                    HasSubstr("'max_value' changes what Home Assistant shows"),
                    HasSubstr("'min_value' changes what Home Assistant shows"),
                    HasSubstr("warning: 'colour' is not carried over: a map has no key for it"),
                    HasSubstr("warning: 'retries' is not carried over: a map has no key for it")));
}

TEST(HomeAssistantImport, Wrong_files_are_refused_where_they_are_wrong) {
  EXPECT_THAT(Imported("home-assistant", "automation:\n  - alias: x\n").said,
              HasSubstr("error: there is no hub of the modbus integration in the file"));
  EXPECT_THAT(hub("sensors: []").said, HasSubstr("error: the hub 'h' has no entities"));
  EXPECT_THAT(hub("sensors: [{name: s}]").said, HasSubstr("given:2:63: error: an entity without 'address'"));
  EXPECT_THAT(hub("sensors: [{address: 1}]").said, HasSubstr("error: an entity without 'name'"));
  EXPECT_THAT(hub("sensors: [{name: s, address: 65536}]").said,
              HasSubstr("error: 'address' is not a whole number from 0 to 65535"));
  EXPECT_THAT(hub("sensors: [{name: s, address: 65535, data_type: int32}]").said,
              HasSubstr("error: 's' does not end before address 65536"));
  EXPECT_THAT(hub("sensors: [{name: s, address: 1, input_type: coil2}]").said,
              HasSubstr("error: 'input_type' is 'coil2', which is not a table"));
  EXPECT_THAT(hub("sensors: [{name: s, address: 1, slave: 256}]").said,
              HasSubstr("error: 'slave' is not a whole number"));
}

// The way back: what the export says of coils, discrete inputs and input registers is all of them.
TEST(HomeAssistantImport, What_the_export_says_wholly_comes_back_with_the_same_fingerprint) {
  const LoadResult loaded = load_map(R"(
name: cell
address: 10.0.0.7
mapping:
  coils:
    lamp: 0
    gate: {address: 1, read_address: 513}
    pulse: {address: 2, access: write}
    state: {address: 3, access: read}
  discrete_inputs: {door: 0}
  input_registers:
    a: {address: 0, type: INT, scale: {gain: 0.1, offset: -40}}
    b: {address: 1, type: UINT, order: BA}
    c: {address: 2, type: DINT, order: ABCD}
    d: {address: 4, type: UDINT, order: CDAB, scale: 0.25}
    e: {address: 6, type: LINT, order: BADC}
    f: {address: 10, type: ULINT, order: DCBA}
    g: {address: 14, type: REAL}
    h: {address: 16, type: LREAL, order: ABCD}
    i: {address: 20, type: STRING, length: 8}
    j: {address: 24, type: STRING, length: 6, order: AB}
    k: {address: 30, type: SINT, offset: high}
    l: {address: 30, type: USINT, offset: low}
    m: {address: 31, type: BOOL, bit: 0}
  holding_registers:
    n: {address: 0, type: REAL, access: read}
)",
                                     "cell.yaml");
  ASSERT_NE(loaded.map, nullptr) << lines_of(loaded.diagnostics);
  const formats::Export exported = formats::write_home_assistant(loaded.map->map());
  const Imported imported("home-assistant", exported.text);
  ASSERT_EQ(imported.result.maps.size(), 1U) << imported.said;
  EXPECT_EQ(imported.result.maps[0].map->map().fingerprint, loaded.map->map().fingerprint)
      << exported.text << imported.text();
}

TEST(HomeAssistantImport, The_connection_comes_back_from_the_export) {
  const std::string points = "mapping: {coils: {lamp: 0}, input_registers: {a: {address: 3, type: INT}}}\n";
  for (const std::string where :
       {"serial: {device: /dev/ttyUSB0, baud: 9600, parity: none, stop_bits: 2}\nunit: 17\ntimeout: 250ms\n",
        "serial: {device: /dev/serial/by-id/usb-1, parity: odd}\nlimits: {request_gap: 5ms}\n",
        "address: 10.0.0.7\nport: 4196\nframing: rtu\nunit: 3\n", "address: 10.0.0.7\ntimeout: 1500ms\n"}) {
    const LoadResult loaded = load_map("name: cell\n" + where + points, "cell.yaml");
    ASSERT_NE(loaded.map, nullptr) << lines_of(loaded.diagnostics);
    const Map& map = loaded.map->map();
    const Imported imported("home-assistant", formats::write_home_assistant(map).text);
    ASSERT_EQ(imported.result.maps.size(), 1U) << imported.said;
    const Map& again = imported.result.maps[0].map->map();
    EXPECT_EQ(again.connection.serial, map.connection.serial) << imported.text();
    EXPECT_EQ(again.connection.framing, map.connection.framing);
    EXPECT_EQ(again.connection.address, map.connection.address);
    EXPECT_EQ(again.connection.port, map.connection.port);
    EXPECT_EQ(again.connection.unit, map.connection.unit);
    EXPECT_EQ(again.connection.timeout, map.connection.timeout);
    EXPECT_EQ(again.limits.request_gap, map.limits.request_gap);
    EXPECT_EQ(again.fingerprint, map.fingerprint);
  }
}

}  // namespace
}  // namespace coupler::test
