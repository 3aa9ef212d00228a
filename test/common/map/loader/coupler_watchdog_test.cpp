// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "coupler/map/loader/preset.hpp"
#include "test/common/map/loader/loaded.hpp"

namespace coupler {
namespace {

using namespace std::chrono_literals;
using test::load_clean;
using test::load_with;
using test::map_of;
using Write = WatchdogSequences::Write;

/// "holding_registers 4096 = 5", one a line.
std::string text_of(Span<const Write> steps) {
  std::string text;
  for (const Write& step : steps)
    text += std::string(to_string(step.table)) + ' ' + std::to_string(step.address) +
            (step.if_different ? " := " : " = ") + std::to_string(step.value) + '\n';
  return text;
}

TEST(CouplerWatchdog, Without_a_preset_the_watchdog_is_the_nodes) {
  const MapPtr map = load_with("watchdog: {timeout: 500ms}");
  EXPECT_TRUE(map->map().service.watchdog.present());
  EXPECT_FALSE(map->map().coupler_watchdog.present());
}

TEST(CouplerWatchdog, A_preset_alone_leaves_it_alone) {
  EXPECT_FALSE(load_with("preset: wago_750")->map().coupler_watchdog.present());
}

TEST(CouplerWatchdog, With_a_preset_it_is_the_couplers_and_not_the_nodes) {
  const MapPtr map = load_with("preset: wago_750\nwatchdog: {timeout: 1500ms, recovery: manual}");
  EXPECT_FALSE(map->map().service.watchdog.present());
  const WatchdogSequences& watchdog = map->map().coupler_watchdog;
  EXPECT_EQ(watchdog.timeout, 1500ms);
  EXPECT_EQ(watchdog.feed_every, 500ms);
  EXPECT_EQ(watchdog.recovery, Watchdog::Recovery::manual);
}

TEST(CouplerWatchdog, It_changes_no_fingerprint) {
  EXPECT_EQ(load_with("preset: wago_750")->map().fingerprint,
            load_with("preset: wago_750\nwatchdog: {timeout: 1s}")->map().fingerprint);
}

TEST(CouplerWatchdog, Wago_counts_in_steps_of_100_ms_and_starts_with_a_change) {
  const MapPtr map = load_with("preset: wago_750\nwatchdog: {timeout: 500ms}");
  const WatchdogSequences& watchdog = map->map().coupler_watchdog;
  EXPECT_EQ(text_of(watchdog.arm),
            "holding_registers 4104 = 43605\nholding_registers 4096 = 5\nholding_registers 4097 = 0\n"
            "holding_registers 4099 = 1\nholding_registers 4099 = 2\n");
  EXPECT_EQ(text_of(watchdog.feed), "holding_registers 4099 = 1\nholding_registers 4099 = 2\n");
  EXPECT_EQ(text_of(watchdog.reset), "holding_registers 4103 = 1\n");
  EXPECT_EQ(watchdog.refusal, modbus::Exception::server_device_failure);
  EXPECT_FALSE(watchdog.alarm);
}

TEST(CouplerWatchdog, Beckhoff_is_written_to_only_where_it_differs_and_fed_by_any_request) {
  const MapPtr map = load_with("preset: beckhoff_bk9000\nwatchdog: {timeout: 750ms}");
  const WatchdogSequences& watchdog = map->map().coupler_watchdog;
  EXPECT_EQ(text_of(watchdog.arm), "holding_registers 4384 := 750\nholding_registers 4386 := 1\n");
  EXPECT_TRUE(watchdog.feed.empty());
  EXPECT_EQ(text_of(watchdog.reset), "holding_registers 4385 = 48847\nholding_registers 4385 = 45054\n");
  EXPECT_EQ(watchdog.refusal, modbus::Exception::server_device_failure);
}

TEST(CouplerWatchdog, Moxa_shows_an_alarm_in_a_coil_and_is_armed_elsewhere) {
  const MapPtr map = load_with("preset: moxa_e1200\nwatchdog: {timeout: 2s}");
  const WatchdogSequences& watchdog = map->map().coupler_watchdog;
  EXPECT_TRUE(watchdog.arm.empty() && watchdog.feed.empty());
  EXPECT_EQ(text_of(watchdog.reset), "coils 4144 = 1\n");
  ASSERT_TRUE(watchdog.alarm);
  EXPECT_EQ(text_of({&*watchdog.alarm, 1}), "coils 4144 = 1\n");
  EXPECT_FALSE(watchdog.refusal);
}

TEST(CouplerWatchdog, What_is_read_of_it_makes_an_area_that_is_read_whole_useful) {
  load_with(
      "preset: moxa_e1200\nwatchdog: {timeout: 2s}\nread_whole: [{table: coils, from: 4144, to: 4151}]");
  load_with(
      "preset: beckhoff_bk9000\nwatchdog: {timeout: 1s}\n"
      "read_whole: [{table: holding_registers, from: 4384, to: 4387}]");
  const std::string only_written =
      "preset: wago_750\nwatchdog: {timeout: 1s}\nread_whole: [{table: holding_registers, from: 4096, to: "
      "4103}]\n";
  const std::string unused = "preset: moxa_e1200\nread_whole: [{table: coils, from: 4144, to: 4151}]\n";
  for (const std::string& top : {only_written, unused})
    EXPECT_NE(test::text_of(test::load_with_lock(map_of("coils", "valve: 1", top), LockUse::read).diagnostics)
                  .find("no point is in this area of 'read_whole'"),
              std::string::npos)
        << top;
}

TEST(CouplerWatchdog, The_map_says_which_register_a_plc_watches) {
  const auto feed = [](const std::string& top, const std::string& heartbeat) {
    const std::string watchdog = "preset: plc\nwatchdog: {timeout: 1s, heartbeat: " + heartbeat + "}";
    const MapPtr map = load_clean(map_of("coils", "valve: 1", top + watchdog));
    EXPECT_TRUE(map->map().coupler_watchdog.present());
    return text_of(map->map().coupler_watchdog.feed);
  };
  EXPECT_EQ(feed("", "100"), "holding_registers 100 = 1\nholding_registers 100 = 2\n");
  EXPECT_EQ(feed("addressing: modicon\n", "40101"), feed("", "100"));
}

TEST(CouplerWatchdog, A_point_may_look_at_what_the_driver_writes) {
  load_clean(map_of("holding_registers", "beat: {address: 100, type: UINT, access: read}",
                    "preset: plc\nwatchdog: {timeout: 1s, heartbeat: 100}"));
}

std::string problem_of(const std::string& watchdog) {
  const auto preset = loader::parse_preset({"other", watchdog});
  return preset ? "" : preset.error();
}

TEST(PresetWatchdog, Each_preset_says_something_of_it) {
  EXPECT_EQ(problem_of("areas: []\n"), "other: nothing is said of a 'watchdog'");
}

TEST(PresetWatchdog, A_coupler_may_have_none) {
  const auto preset = loader::parse_preset({"other", "watchdog: none\n"});
  ASSERT_TRUE(preset) << preset.error();
  EXPECT_TRUE(preset->watchdog.none);
}

TEST(PresetWatchdog, What_makes_no_sense_is_refused_with_its_line) {
  EXPECT_EQ(problem_of("areas: []\nwatchdog: off\n"), "other: line 2 is not an element of 'watchdog'");
  for (const char* part :
       {"arm: [{holding_register: 1}]", "arm: [{value: 1}]", "arm: [{holding_register: 65536, value: 1}]",
        "arm: [{coil: 1, value: timeout}]", "arm: [{coil: 1, value: timeout, unit: 0}]",
        "arm: [{coil: 1, value: timeout, unit: fast}]", "arm: {coil: 1, value: 1}",
        "reset: [{coil: 1, value: on}]", "feed: {holding_register: 1}",
        "feed: {holding_register: 1, values: []}", "feed: {holding_register: 1, values: [x]}",
        "feed: {values: [1]}", "expired: {exception: 256}", "expired: {exception: 0}",
        "expired: {coil: heartbeat, value: 1}", "expired: {coil: 1}", "fed: {}"})
    EXPECT_EQ(problem_of(std::string("watchdog:\n  ") + part),
              "other: line 2 is not an element of 'watchdog'")
        << part;
}

}  // namespace
}  // namespace coupler
