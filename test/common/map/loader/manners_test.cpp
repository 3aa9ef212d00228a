// SPDX-License-Identifier: Apache-2.0
// Arrays, scaling, analogue channels, and what the host does with points. What is refused is in
// test/maps/bad.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "coupler/codec/scale.hpp"
#include "test/common/map/loader/loaded.hpp"

namespace coupler {
namespace {

using namespace std::chrono_literals;
using test::load_clean;
using test::map_of;
using test::OnePoint;
using Words = std::vector<std::uint16_t>;

Words words(Span<const std::uint16_t> span) { return {span.begin(), span.end()}; }

TEST(Array, Its_range_holds_all_its_values) {
  EXPECT_EQ(range(*OnePoint("coils", "{address: 4, count: 8}").operator->()), modbus::Range::of(4, 8));
  EXPECT_EQ(range(*OnePoint("input_registers", "{address: 4, type: DINT, count: 3}").operator->()),
            modbus::Range::of(4, 6));
}

TEST(Array, Its_initial_value_is_a_list_or_one_for_all) {
  EXPECT_EQ(words(OnePoint("coils", "{address: 0, count: 3, initial: [on, off, on]}")->initial),
            (Words{1, 0, 1}));
  EXPECT_EQ(
      words(OnePoint("holding_registers", "{address: 0, type: INT, count: 2, initial: [7, -1]}")->initial),
      (Words{7, 0xFFFF}));
  EXPECT_EQ(words(OnePoint("holding_registers", "{address: 0, type: DINT, order: ABCD, count: 2, initial: 1}")
                      ->initial),
            (Words{0, 1, 0, 1}));
}

TEST(Scaled, A_number_is_the_gain_and_a_map_has_the_offset_too) {
  const OnePoint gain("input_registers", "{address: 0, type: INT, scale: 0.1}");
  EXPECT_EQ(gain->scale.gain, 0.1);
  EXPECT_EQ(gain->scale.offset, 0);
  const OnePoint both("input_registers", "{address: 0, type: INT, scale: {gain: 2, offset: -40}}");
  EXPECT_EQ(both->scale.gain, 2);
  EXPECT_EQ(both->scale.offset, -40);
}

TEST(Scaled, Values_in_the_map_are_written_as_they_are_published) {
  const OnePoint point(
      "holding_registers",
      "{address: 0, type: INT, scale: 0.1, initial: 12.5, deadman: {timeout: 1s, value: -1}}");
  EXPECT_EQ(words(point->initial), Words{125});
  EXPECT_EQ(words(point->host.deadman.value), Words{0xFFF6});
}

TEST(Scaled, A_bound_may_be_the_last_value_of_the_type_however_that_is_rounded) {
  for (const char* options : {"type: UINT, scale: {gain: 0.001, offset: -40}, max: 25.535",
                              "type: INT, scale: {gain: 0.01, offset: -273.15}, min: -600.83",
                              "type: INT, scale: 0.7, max: 22936.9",
                              "type: DINT, scale: {gain: 0.005, offset: -273.15}, max: 10737145.085"})
    OnePoint("holding_registers", std::string("{address: 0, ") + options + "}");
}

TEST(Scaled, A_bound_beyond_the_last_value_is_none) {
  const auto loaded =
      load_map(map_of("holding_registers",
                      "a: {address: 0, type: UINT, scale: {gain: 0.001, offset: -40}, max: 25.536}"),
               "map");
  EXPECT_FALSE(loaded.map);
}

TEST(Analogue, A_register_names_the_channel_behind_it) {
  const OnePoint in("input_registers", "{address: 0, type: INT, iio: {device: adc0, channel: voltage3}}");
  EXPECT_EQ(in->iio.device, "adc0");
  EXPECT_EQ(in->iio.channel, "voltage3");
  const OnePoint out("holding_registers",
                     "{address: 0, type: UINT, pwm: {chip: pwmchip0, channel: 2, period: 50us}}");
  EXPECT_EQ(out->pwm.chip, "pwmchip0");
  EXPECT_EQ(out->pwm.channel, 2);
  EXPECT_EQ(out->pwm.period, 50us);
  EXPECT_EQ(out->safe, Safe::off);
}

TEST(Analogue, Its_safe_state_is_off_hold_or_a_value) {
  const std::string pwm =
      "{address: 0, type: UINT, scale: 0.5, pwm: {chip: p, channel: 0, period: 1ms}, safe: ";
  EXPECT_EQ(OnePoint("holding_registers", pwm + "hold}")->safe, Safe::hold);
  EXPECT_EQ(OnePoint("holding_registers", pwm + "off}")->safe, Safe::off);
  const OnePoint value("holding_registers", pwm + "25}");
  EXPECT_EQ(value->safe, Safe::on);
  EXPECT_EQ(words(value->safe_value), Words{50});
}

TEST(HostOptions, A_point_has_its_own) {
  const OnePoint point(
      "holding_registers",
      "{address: 0, type: INT, rate: 2, publish: on_change, deadband: 0.5, max_interval: 3s, "
      "latch: true, queue_size: 4, write_function: multiple, write_queue: every, priority: high, "
      "verify_write: true, deadman: {timeout: 250ms, value: 7}, read_address: 512}");
  const HostOptions& host = point->host;
  EXPECT_EQ(host.rate, 2);
  EXPECT_EQ(host.publish, HostOptions::Publish::on_change);
  EXPECT_EQ(host.deadband, 0.5);
  EXPECT_EQ(host.max_interval, 3s);
  EXPECT_TRUE(host.latch);
  EXPECT_EQ(host.queue_size, 4U);
  EXPECT_EQ(host.write_function, HostOptions::WriteFunction::multiple);
  EXPECT_EQ(host.write_queue, HostOptions::WriteQueue::every);
  EXPECT_EQ(host.priority, HostOptions::Priority::high);
  EXPECT_TRUE(host.verify_write);
  EXPECT_EQ(host.deadman.timeout, 250ms);
  EXPECT_EQ(words(host.deadman.value), Words{7});
  EXPECT_EQ(read_range(*point.operator->()), modbus::Range::of(512, 1));
}

TEST(HostOptions, Defaults_are_for_points_that_say_nothing) {
  const std::string defaults = "defaults: {rate: 2, publish: on_change, verify_write: true}";
  EXPECT_EQ(OnePoint("coils", "0", defaults)->host.rate, 2);
  EXPECT_TRUE(OnePoint("coils", "0", defaults)->host.verify_write);
  EXPECT_EQ(OnePoint("coils", "{address: 0, rate: 7}", defaults)->host.rate, 7);
  EXPECT_EQ(OnePoint("coils", "{address: 0, publish: always}", defaults)->host.publish,
            HostOptions::Publish::always);
}

TEST(HostOptions, A_default_that_a_point_cannot_have_is_not_its_own) {
  const std::string defaults =
      "defaults: {publish: on_change, deadband: 2, write_function: single, verify_write: true, deadman: "
      "{timeout: "
      "1s, value: 0}}";
  EXPECT_EQ(OnePoint("discrete_inputs", "0", defaults)->host.deadband, 0);
  EXPECT_FALSE(OnePoint("discrete_inputs", "0", defaults)->host.verify_write);
  EXPECT_FALSE(OnePoint("discrete_inputs", "0", defaults)->host.deadman.present());
  EXPECT_EQ(OnePoint("holding_registers", "{address: 0, type: DINT}", defaults)->host.write_function,
            HostOptions::WriteFunction::automatic);
  EXPECT_EQ(words(OnePoint("holding_registers", "{address: 0, type: DINT}", defaults)->host.deadman.value),
            (Words{0, 0}));
}

TEST(HostOptions, A_priority_of_all_points_is_for_those_that_are_written) {
  using Priority = HostOptions::Priority;
  const std::string defaults = "defaults: {priority: high}";
  EXPECT_EQ(OnePoint("coils", "0", defaults)->host.priority, Priority::high);
  EXPECT_EQ(OnePoint("coils", "{address: 0, access: write}", defaults)->host.priority, Priority::high);
  EXPECT_EQ(OnePoint("coils", "{address: 0, priority: normal}", defaults)->host.priority, Priority::normal);
  EXPECT_EQ(OnePoint("coils", "{address: 0, access: read}", defaults)->host.priority, Priority::normal);
  EXPECT_EQ(OnePoint("discrete_inputs", "0", defaults)->host.priority, Priority::normal);
}

TEST(HostOptions, What_is_only_written_is_not_read_back) {
  const std::string defaults = "defaults: {verify_write: true}";
  EXPECT_FALSE(OnePoint("coils", "{address: 0, access: write}", defaults)->host.verify_write);
  EXPECT_FALSE(
      OnePoint("coils", "{address: 0, access: write, verify_write: false}", defaults)->host.verify_write);
  EXPECT_FALSE(OnePoint("coils", "{address: 0, pulse: 200ms}", defaults)->host.verify_write)
      << "it is off again by then";
}

TEST(HostOptions, Defaults_stamp_what_is_read_and_no_array) {
  const std::string defaults = "defaults: {stamped: true}";
  EXPECT_TRUE(OnePoint("coils", "{address: 0}", defaults)->host.stamped);
  EXPECT_TRUE(OnePoint("input_registers", "{address: 0, type: STRING, length: 4}", defaults)->host.stamped);
  EXPECT_FALSE(OnePoint("coils", "{address: 0, stamped: false}", defaults)->host.stamped);
  EXPECT_FALSE(OnePoint("coils", "{address: 0, count: 8}", defaults)->host.stamped);
  EXPECT_FALSE(OnePoint("coils", "{address: 0, count: 8, stamped: false}", defaults)->host.stamped);
  EXPECT_FALSE(OnePoint("coils", "{address: 0, access: write}", defaults)->host.stamped);
  EXPECT_FALSE(OnePoint("coils", "{address: 0}")->host.stamped);
}

TEST(HostOptions, What_is_only_written_may_be_longer_than_what_the_device_sends) {
  const OnePoint recipe("holding_registers", "{address: 0, type: INT, count: 20, access: write}",
                        "limits: {read_registers: 16, write_registers: 32}\n");
  EXPECT_EQ(recipe->count, 20);
}

TEST(TableRange, Parts_of_a_register_are_there_if_the_device_writes_them_by_itself) {
  load_clean(map_of("holding_registers", "a: {address: 0, type: BOOL, bit: 0, access: write}",
                    "unreadable: [{table: holding_registers, from: 0, to: 0}]\n"
                    "limits: {mask_write: true}\n"));
}

TEST(TableRange, Areas_are_sorted_and_in_the_addressing_of_the_map) {
  const MapPtr map = load_clean(map_of("coils", "p: 1",
                                       "addressing: modicon\n"
                                       "unreadable: [{table: holding_registers, from: 40011, to: 40020},"
                                       " {table: coils, from: 9, to: 16}]"));
  ASSERT_EQ(map->map().unreadable.size(), 2U);
  EXPECT_EQ(map->map().unreadable[0].table, Table::coils);
  EXPECT_EQ(map->map().unreadable[0].range, modbus::Range::of(8, 8));
  EXPECT_EQ(map->map().unreadable[1].range, modbus::Range::of(10, 10));
}

TEST(Link, What_becomes_of_outputs_and_which_points_are_read_is_said_at_the_top) {
  const MapPtr map = load_clean(
      map_of("coils", "p: 1",
             "on_reconnect: restore\non_shutdown: safe\npoll: subscribed\nchanges: off\nverify: off\n"
             "wait_for: true"));
  EXPECT_EQ(map->map().on_reconnect, OnReconnect::restore);
  EXPECT_EQ(map->map().on_shutdown, OnShutdown::safe);
  EXPECT_EQ(map->map().poll, Poll::subscribed);
  EXPECT_EQ(map->map().verify, Verify::off);
  EXPECT_FALSE(map->map().changes);
  EXPECT_TRUE(map->map().wait_for);
  EXPECT_FALSE(load_clean(map_of("coils", "p: 1"))->map().wait_for);
  EXPECT_EQ(load_clean(map_of("coils", "p: 1"))->map().poll, Poll::all);
  EXPECT_TRUE(load_clean(map_of("coils", "p: 1"))->map().changes);
}

TEST(Manners, Every_word_of_YAML_for_on_and_off_is_a_safe_state) {
  for (const char* word : {"off", "no", "No", "NO", "false", "\"no\""}) {
    EXPECT_EQ(OnePoint("coils", fmt::format("{{address: 1, safe: {}}}", word))->safe, Safe::off) << word;
    const OnePoint pwm("holding_registers",
                       fmt::format("{{address: 0, type: UINT, pwm: {{chip: p, channel: 0, period: 1ms}}, "
                                   "safe: {}}}",
                                   word));
    EXPECT_EQ(pwm->safe, Safe::off) << word;
  }
  for (const char* word : {"on", "yes", "Yes", "true", "TRUE"})
    EXPECT_EQ(OnePoint("coils", fmt::format("{{address: 1, safe: {}}}", word))->safe, Safe::on) << word;
}

TEST(Manners, Any_output_may_say_what_is_safe_for_it) {
  const MapPtr coils = load_clean(map_of("coils", "p: {address: 1, safe: on}"));
  EXPECT_EQ(coils->map().points[0].safe, Safe::on);
  const MapPtr registers =
      load_clean(map_of("holding_registers", "p: {address: 1, type: UINT, scale: 0.5, safe: 4}"));
  EXPECT_EQ(registers->map().points[0].safe, Safe::on);
  EXPECT_EQ(registers->map().points[0].safe_value[0], 8);
}

TEST(Manners, What_is_safe_for_an_array_of_coils_is_one_word_or_a_list) {
  const std::string car = "{address: 4, count: 3, safe: ";
  const OnePoint list("coils", car + "[on, off, on]}", "on_shutdown: safe");
  EXPECT_EQ(list->safe, Safe::on);
  EXPECT_EQ(words(list->safe_value), (Words{1, 0, 1}));
  const OnePoint word("coils", car + "on}", "on_shutdown: safe");
  EXPECT_EQ(word->safe, Safe::on);
  EXPECT_TRUE(word->safe_value.empty());
  EXPECT_EQ(OnePoint("coils", car + "hold}", "on_shutdown: safe")->safe, Safe::hold);
}

TEST(Manners, Two_points_of_a_line_are_a_gain_and_an_offset) {
  const OnePoint current("input_registers",
                         "{address: 0, type: UINT, scale: {raw: [4000, 20000], value: [0, 10]}}");
  EXPECT_EQ(current->scale.gain, 0.000625);
  EXPECT_EQ(current->scale.offset, -2.5);
  const OnePoint falling("input_registers",
                         "{address: 0, type: INT, scale: {raw: [0, -27648], value: [100, 0]}}");
  EXPECT_DOUBLE_EQ(-27648 * falling->scale.gain + falling->scale.offset, 0);
  EXPECT_EQ(falling->scale.offset, 100);
}

TEST(Manners, Raw_values_that_are_none_are_the_bits_of_the_type) {
  using Ranges = std::vector<std::pair<std::uint64_t, std::uint64_t>>;
  const std::pair<const char*, Ranges> cases[] = {
      {"type: INT, invalid: 0x8000", {{0x8000, 0x8000}}},
      {"type: INT, invalid: -32768", {{0x8000, 0x8000}}},
      {"type: INT, invalid: 32768", {{0x8000, 0x8000}}},
      {"type: SINT, offset: low, invalid: [-1, 0x7F]", {{0xFF, 0xFF}, {0x7F, 0x7F}}},
      {"type: INT, invalid: [[-2, 3], [0x7FF0, 0x7FFF]]", {{0xFFFE, 0xFFFF}, {0, 3}, {0x7FF0, 0x7FFF}}},
      {"type: INT, invalid: [[-5, -2]]", {{0xFFFB, 0xFFFE}}},
      {"type: ULINT, invalid: 0xFFFFFFFFFFFFFFFF", {{~std::uint64_t{0}, ~std::uint64_t{0}}}},
      {"type: LINT, invalid: -9223372036854775808", {{1ULL << 63U, 1ULL << 63U}}},
      {"type: BOOL, bit: 2, invalid: 0xFFFF", {{0xFFFF, 0xFFFF}}},
      {"type: REAL, invalid: -9999", {{0xC61C3C00, 0xC61C3C00}}},
      {"type: REAL, invalid: 0x7FC00000", {{0x7FC00000, 0x7FC00000}}},
      {"type: REAL, invalid: nan", {{0x7F800001, 0x7FFFFFFF}, {0xFF800001, 0xFFFFFFFF}}},
      {"type: REAL, invalid: [[-2, -1], [1, 2]]", {{0xBF800000, 0xC0000000}, {0x3F800000, 0x40000000}}},
      {"type: LREAL, invalid: .nan",
       {{0x7FF0000000000001, 0x7FFFFFFFFFFFFFFF}, {0xFFF0000000000001, 0xFFFFFFFFFFFFFFFF}}},
  };
  for (const auto& [options, ranges] : cases) {
    const OnePoint point("input_registers", fmt::format("{{address: 0, {}}}", options));
    Ranges found;
    for (const auto& [first, last] : point->invalid) found.emplace_back(first, last);
    EXPECT_EQ(found, ranges) << options;
  }
}

TEST(Manners, An_input_may_begin_without_a_value_and_have_a_name_for_it) {
  const OnePoint temp(
      "input_registers",
      "{address: 0, type: INT, invalid: -32768, initial: -32768, values: {-32768: none, 0: cold}}");
  EXPECT_EQ(temp->initial[0], 0x8000);
  EXPECT_EQ(temp->values.size(), 2U);
}

}  // namespace
}  // namespace coupler
