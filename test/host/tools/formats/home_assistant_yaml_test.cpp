// SPDX-License-Identifier: Apache-2.0
// What a configuration of Home Assistant has besides plain YAML: secrets, anchors, the form of old versions.
#include <gmock/gmock.h>

#include <fmt/format.h>

#include "test/host/tools/formats/imported.hpp"

namespace coupler::test {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

const std::string yaml_head = "modbus:\n- type: tcp\n  host: plc\n  port: 502\n";

Imported yaml_hub(const std::string& lines) { return Imported("home-assistant", yaml_head + lines); }

TEST(HomeAssistantYaml, A_secret_unit_of_all_entities_is_left_out) {
  const std::string text =
      "  sensors:\n  - {name: a, slave: !secret u, address: 1}\n  - {name: b, slave: !secret u, address: "
      "2}\n";
  const Imported imported = yaml_hub(text);
  EXPECT_THAT(imported.text(), AllOf(HasSubstr("a: {"), HasSubstr("b: {"), Not(HasSubstr("unit:"))));
  EXPECT_EQ(imported.result.diagnostics.size(), 2U) << imported.said;
  EXPECT_THAT(imported.said,
              HasSubstr("given:6:22: warning: the unit id is a secret, which is not read, so it is left "
                        "out; give it with --unit"));
  EXPECT_THAT(Imported("home-assistant", yaml_head + text, {"h", 9}).text(), HasSubstr("unit: 9\n"));
}

TEST(HomeAssistantYaml, Secret_units_that_differ_are_not_taken_for_one) {
  for (const char* other : {", slave: !secret v", ", device_address: 3", ""}) {
    const Imported imported = yaml_hub(fmt::format(
        "  sensors:\n  - {{name: a, slave: !secret u, address: 1}}\n  - {{name: b{}, address: 1}}\n", other));
    EXPECT_TRUE(imported.result.maps.empty());
    EXPECT_EQ(imported.result.diagnostics.size(), 1U) << imported.said;
    EXPECT_THAT(imported.said, AllOf(HasSubstr("error: it is not known whether this entity is of the same "
                                               "unit as the one in line 6: a unit id"),
                                     HasSubstr("write the unit ids of all entities as numbers")));
  }
}

TEST(HomeAssistantYaml, A_secret_address_is_asked_for) {
  const Imported imported = yaml_hub("  sensors: [{name: a, address: !secret x}]\n");
  EXPECT_THAT(
      imported.said,
      AllOf(HasSubstr("given:5:32: error: 'address' is a secret, which is not read; write the number"),
            Not(HasSubstr("without 'address'"))));
}

TEST(HomeAssistantYaml, Slave_count_is_virtual_count) {
  EXPECT_THAT(yaml_hub("  sensors: [{name: a, address: 1, slave_count: 2, virtual_count: 2}]\n").text(),
              HasSubstr("count: 3"));
  EXPECT_THAT(
      yaml_hub("  sensors: [{name: a, address: 1, slave_count: 2, virtual_count: 3}]\n").said,
      HasSubstr(
          "given:5:48: error: 'slave_count' and 'virtual_count' mean the same, but differ; remove one"));
  EXPECT_THAT(yaml_hub("  binary_sensors: [{name: a, address: 1, slave_count: 2, virtual_count: 3}]\n").said,
              HasSubstr("mean the same, but differ"));
  EXPECT_THAT(yaml_hub("  sensors: [{name: a, address: 1, slave_count: 2, count: 2}]\n").said,
              HasSubstr("error: 'count' is 2, but int16 has 1 register"));
  const Imported text =
      yaml_hub("  sensors: [{name: a, address: 1, data_type: string, count: 2, slave_count: 2}]\n");
  EXPECT_THAT(text.text(), HasSubstr("a: {address: 1, type: STRING, length: 4"));
  EXPECT_THAT(text.said,
              HasSubstr("given:5:77: warning: 'slave_count' is left out: Home Assistant repeats numbers"));
}

TEST(HomeAssistantYaml, The_platform_of_old_versions_is_told) {
  const std::string old =
      "sensor:\n  - platform: modbus\n    registers: [{name: a, hub: h, register: 1}]\n"
      "switch:\n  - {platform: \"modbus\", coils: []}\n  # platform: modbus\n  - platform: modbus2\n";
  const Imported beside("home-assistant", old + yaml_head + "  sensors: [{name: s, address: 1}]\n");
  EXPECT_THAT(beside.text(), HasSubstr("s: {address: 1,"));
  EXPECT_THAT(beside.said, AllOf(HasSubstr("given:2:5: warning: 'platform: modbus' is an old form"),
                                 HasSubstr("given:5:6: warning: "), Not(HasSubstr("given:6:")),
                                 Not(HasSubstr("given:7:"))));
  EXPECT_THAT(
      Imported("home-assistant", old).said,
      AllOf(HasSubstr("given:2:5: error: 'platform: modbus' is an old form"),
            HasSubstr("'address' in place of 'register' and 'coil'"), Not(HasSubstr("there is no hub"))));
}

TEST(HomeAssistantYaml, Anchors_aliases_and_merge_keys_are_read) {
  const Imported imported("home-assistant", R"(.defaults: &d
  scan_interval: 5
  slave: &u 7
  input_type: input
automation: !include automations.yaml
modbus:
- type: tcp
  host: &host "plc"
  port: 502
  binary_sensors: [{<<: *d, name: x, address: 9, input_type: discrete_input}]
  sensors:
  - &base
    <<: *d
    name: a
    address: 1
  - <<: [{address: 2}, *base]
    name: b
  - {<<: *base, name: c, address: 3, slave: *u}
)");
  EXPECT_THAT(imported.text(), HasSubstr("address: plc\nport: 502\nunit: 7\nrate: 0.2\nmapping:\n"
                                         "  discrete_inputs:\n    x: 9\n"
                                         "  input_registers:\n    a: {address: 1, type: INT}\n"
                                         "    b: {address: 2, type: INT}\n    c: {address: 3, type: INT}\n"));
  EXPECT_EQ(imported.said, "");
  EXPECT_THAT(yaml_hub("  name: &n !secret x\n  sensors: [{name: s, address: 1}]\n").said,
              HasSubstr("'name' is a secret, which is not read"));
}

TEST(HomeAssistantYaml, Wrong_aliases_are_refused_where_they_stand) {
  EXPECT_THAT(yaml_hub("  sensors: [{name: *n, address: 1}]\n").said,
              HasSubstr("given:5:20: error: no anchor of that name stands before the alias"));
  EXPECT_THAT(yaml_hub("  sensors: &s [*s]\n").said,
              HasSubstr("given:5:16: error: the alias stands inside the value that it names"));
  EXPECT_THAT(yaml_hub("  sensors: [{<<: 5, name: a, address: 1}]\n").said,
              HasSubstr("given:5:18: error: a merge key ('<<') needs a map"));
  EXPECT_THAT(yaml_hub("  sensors: [&n {name: a, address: 70000}, *n]\n").said,
              HasSubstr("given:5:35: error: 'address'"));
  EXPECT_THAT(yaml_hub("  sensors: [&n {? *n : 1}]\n").said, HasSubstr("error: "));
}

TEST(HomeAssistantYaml, Bombs_of_aliases_are_refused) {
  std::string wide = yaml_head + "  a: &a [x, x, x, x]\n";
  for (char name = 'b'; name <= 'z'; ++name)
    wide += fmt::format("  {0}: &{0} [*{1}, *{1}, *{1}, *{1}]\n", name, static_cast<char>(name - 1));
  std::string merges = yaml_head + "  m0: &m0 {k: 1}\n";
  std::string deep = yaml_head + "  d0: &d0 [x]\n";
  for (int i = 1; i < 20000; ++i) {
    merges += fmt::format("  m{0}: &m{0} {{<<: *m{1}, k{0}: 1}}\n", i, i - 1);
    deep += fmt::format("  d{0}: &d{0} [*d{1}]\n", i, i - 1);
  }
  std::string long_text = yaml_head + "  l: &l " + std::string(1'000'000, 'x') + "\n";
  for (int i = 0; i < 1000; ++i) long_text += fmt::format("  l{}: *l\n", i);
  EXPECT_THAT(Imported("home-assistant", wide).said, HasSubstr("error: "));
  EXPECT_THAT(Imported("home-assistant", merges).said,
              HasSubstr("error: aliases of this value make the file too large"));
  EXPECT_THAT(Imported("home-assistant", deep).said, HasSubstr("error: the values are nested too deep"));
  EXPECT_THAT(Imported("home-assistant", long_text).said,
              HasSubstr("error: aliases of this value make the file too large"));
}

TEST(HomeAssistantYaml, Only_the_hub_that_is_chosen_is_read) {
  const std::string text =
      "modbus:\n- {name: a, type: tcp, host: plc, sensors: [{name: s, address: 1}]}\n"
      "- {name: b, type: tcp, host: plc, binary_sensors: !include b.yaml, sensors: [{name: t, address: "
      "!secret x}]}\n"
      "- !include c.yaml\n";
  formats::ImportOptions options{"m", {}};
  options.device = "a";
  const Imported chosen("home-assistant", text, options);
  EXPECT_THAT(chosen.text(), HasSubstr("s: {address: 1"));
  EXPECT_THAT(chosen.said, Not(HasSubstr("error")));
  options.device = "b";
  EXPECT_THAT(Imported("home-assistant", text, options).said,
              AllOf(HasSubstr("'binary_sensors' stands in another file"), HasSubstr("'address' is a secret"),
                    Not(HasSubstr("given:4"))));
  EXPECT_THAT(Imported("home-assistant", text).said,
              AllOf(HasSubstr("given:4:3: error: the value stands in another file"),
                    HasSubstr("several hubs: a, b")));
}

TEST(HomeAssistantYaml, A_problem_behind_an_alias_is_told_once) {
  const std::string said = Imported("home-assistant",
                                    "x: &x\n  y: !secret foo\nmodbus:\n- type: tcp\n  host: plc\n  sensors:\n"
                                    "  - {<<: *x, name: a, address: 1}\n  - {<<: *x, name: b, address: 2}\n")
                               .said;
  EXPECT_EQ(said.find("'y' is a secret"), said.rfind("'y' is a secret")) << said;
  EXPECT_NE(said.find("'y' is a secret"), std::string::npos) << said;
}

TEST(HomeAssistantYaml, A_secret_is_the_same_in_quotes) {
  EXPECT_THAT(yaml_hub("  sensors:\n  - {name: a, slave: !secret u, address: 1}\n"
                       "  - {name: b, slave: !secret \"u\", address: 2}\n")
                  .text(),
              AllOf(HasSubstr("a: {"), HasSubstr("b: {")));
}

TEST(HomeAssistantYaml, Keys_may_stand_in_quotes) {
  EXPECT_THAT(Imported("home-assistant",
                       "automation: !include a.yaml\n\"modbus\":\n- {type: tcp, host: plc, sensors: "
                       "[{name: s, address: 1}]}\n")
                  .text(),
              HasSubstr("s: {address: 1"));
  EXPECT_THAT(
      Imported("home-assistant", "sensor:\n- \"platform\": modbus\n").said,
      AllOf(HasSubstr("given:2:4: error: 'platform: modbus' is an old form"), Not(HasSubstr("left out"))));
}

TEST(HomeAssistantYaml, Hubs_of_a_package_are_found) {
  const std::string hub = "modbus: [{type: tcp, host: plc, sensors: [{name: s, address: 1}]}]\n";
  EXPECT_THAT(Imported("home-assistant", "solar:\n  " + hub).text(), HasSubstr("s: {address: 1"));
  EXPECT_THAT(Imported("home-assistant",
                       "script: !include s.yaml\nhomeassistant:\n  packages:\n    solar:\n      " + hub)
                  .text(),
              HasSubstr("s: {address: 1"));
  const Imported both("home-assistant", "homeassistant:\n  packages:\n    solar:\n      " + hub + hub);
  EXPECT_THAT(both.text(), HasSubstr("s: {address: 1"));
  EXPECT_THAT(both.said,
              HasSubstr("given:4:1: warning: the hubs of this 'modbus:' below another key are not read"));
}

TEST(HomeAssistantYaml, Another_key_called_modbus_is_no_package) {
  EXPECT_EQ(Imported("home-assistant",
                     "logger:\n  logs:\n    modbus: debug\nmodbus:\n- {type: tcp, host: plc, sensors: "
                     "[{name: s, address: 1, input_type: input}]}\n")
                .said,
            "");
}

TEST(HomeAssistantYaml, Names_are_spelt_in_ASCII) {
  const Imported imported("home-assistant",
                          "modbus:\n- {name: Wärmepumpe, type: tcp, host: plc, sensors: [{name: Ölstand, "
                          "address: 1}]}\n");
  EXPECT_THAT(imported.text(), AllOf(HasSubstr("name: waermepumpe\n"), HasSubstr("oelstand: {address: 1")));
}

}  // namespace
}  // namespace coupler::test
