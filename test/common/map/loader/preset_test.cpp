// SPDX-License-Identifier: Apache-2.0
#include "coupler/map/loader/preset.hpp"

#include <gtest/gtest.h>

#include "test/common/map/loader/loaded.hpp"

namespace coupler {
namespace {

using test::load_clean;
using test::load_with;
using test::map_of;

TEST(Preset, Each_one_can_be_used) {
  for (const loader::PresetFile& file : loader::preset_files()) {
    SCOPED_TRACE(file.name);
    const auto preset = loader::parse_preset(file);
    ASSERT_TRUE(preset) << preset.error();
    load_clean(map_of("coils", "valve: 0", "preset: " + std::string(file.name)));
  }
}

TEST(Preset, What_is_no_area_is_refused_with_its_line) {
  const auto preset =
      loader::parse_preset({"other", "watchdog: {}\nareas:\n  - {table: coils, from: 3, to: 2}\n"});
  ASSERT_FALSE(preset);
  EXPECT_EQ(preset.error(), "other: line 3 is not an element of 'areas'");
}

TEST(Preset, Its_limits_hold_where_the_map_has_none_of_its_own) {
  const MapPtr map =
      load_clean(map_of("coils", "valve: 0", "preset: wago_750\nlimits: {write_registers: 7}"));
  EXPECT_EQ(map->map().limits.write_registers, 7);
  EXPECT_EQ(map->map().limits.write_bits, 800);
}

TEST(Preset, Its_serial_settings_are_for_a_port_that_the_map_or_a_setting_names) {
  const MapPtr line = load_with("preset: robotiq_2f\nserial: {device: /dev/ttyUSB0}");
  EXPECT_EQ(line->map().connection.serial, (Serial{"/dev/ttyUSB0", 115200, Serial::Parity::none, 1, false}));
  EXPECT_EQ(line->map().connection.unit, 9);
  const MapPtr own = load_with("preset: robotiq_2f\nserial: {device: /dev/ttyUSB0, baud: 9600}\nunit: 17");
  EXPECT_EQ(own->map().connection.serial, (Serial{"/dev/ttyUSB0", 9600, Serial::Parity::none, 1, false}));
  EXPECT_EQ(own->map().connection.unit, 17);
  const MapPtr gateway = load_with("preset: robotiq_2f\naddress: gateway");
  EXPECT_EQ(gateway->map().connection.serial, (Serial{"", 115200, Serial::Parity::none, 1, false}));
  EXPECT_FALSE(gateway->map().connection.is_rtu());
  EXPECT_EQ(gateway->map().connection.unit, 9);
}

TEST(Preset, Its_write_function_holds_for_each_output) {
  const std::string points = "target: {address: 0x03E9, type: UINT, access: write}";
  const MapPtr map = load_clean(map_of("holding_registers", points, "preset: robotiq_2f"));
  EXPECT_EQ(map->map().points[0].host.write_function, HostOptions::WriteFunction::multiple);
}

TEST(Preset, The_maps_own_order_wins) {
  const std::string points = "speed: {address: 0, type: DINT}";
  const auto order = [&](const std::string& top) {
    return load_clean(map_of("holding_registers", points, top))->map().points[0].format.order;
  };
  EXPECT_EQ(order("preset: moxa_e1200"), codec::Order::ABCD);
  EXPECT_EQ(order("preset: moxa_e1200\nwordorder_reverse: false"), codec::Order::CDAB);
}

TEST(Preset, Outputs_are_read_where_the_coupler_shows_them) {
  const MapPtr map = load_clean(map_of(
      "coils", "valve: 3, own: {address: 4, read_address: 100}, blind: {address: 5, access: write}, far: 515",
      "preset: wago_750"));
  EXPECT_EQ(read_range(*find(map->map(), "valve")).start(), 515);
  EXPECT_EQ(read_range(*find(map->map(), "own")).start(), 100);
  EXPECT_FALSE(find(map->map(), "blind")->read_address);
  EXPECT_EQ(read_range(*find(map->map(), "far")).start(), 515);
}

}  // namespace
}  // namespace coupler
