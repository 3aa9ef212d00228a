// SPDX-License-Identifier: Apache-2.0
// Values that mean that a device has none, and scales whose exponent is in a register of the device.
#include <gmock/gmock.h>

#include "coupler/host/core/value_text.hpp"
#include "coupler/map/loader/load.hpp"
#include "test/host/core/device_fixture.hpp"

namespace coupler::host {
namespace {

using std::chrono::milliseconds;
using test::DeviceTest;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using State = PointQuality::State;

struct InvalidValuesTest : DeviceTest {
  void read(const std::string& points) {
    const LoadResult loaded =
        load_map("name: meter\nverify: off\nrate: 10\nmapping:\n  input_registers:\n" + points, "meter.yaml");
    ASSERT_NE(loaded.map, nullptr) << loaded.diagnostics.front().what;
    owned = loaded.map;
    device.now = [this] { return clock.now(); };
    make_sink();
    make_engine(Verify::off, load_served_map);
  }
  void set(std::uint32_t address, std::uint16_t value) {
    device.values[{Table::input_registers, address}] = value;
  }
  std::uint32_t index(std::string_view point) const {
    return static_cast<std::uint32_t>(find(owned->map(), point) - owned->map().points.begin());
  }
  PointQuality quality(std::string_view point) const { return table->quality(index(point), clock.now()); }
  /// The value in words; "-" if there is none.
  std::string value(std::string_view point) const {
    const ValueTable::Value value = table->get(index(point), clock.now());
    return value.has_value() ? format_value(value.registers.data(), owned->map().points[index(point)]) : "-";
  }
};

TEST_F(InvalidValuesTest, A_value_that_means_none_is_read_but_not_told_as_one) {
  read("    temp: {address: 0, type: INT, scale: 0.1, invalid: 0x8000}\n");
  set(0, 0x8000);
  run_for(milliseconds(50));
  EXPECT_EQ(quality("temp").state, State::invalid);
  EXPECT_EQ(quality("temp").why, "the device gives 0x8000, which the map calls invalid");
  EXPECT_EQ(value("temp"), "-");
  EXPECT_THAT(sink->values["temp"], IsEmpty());
  EXPECT_GT(sink->no_values["temp"], 0);
  set(0, 215);
  run_for(milliseconds(100));
  EXPECT_EQ(quality("temp").state, State::good);
  EXPECT_EQ(value("temp"), "21.5");
  EXPECT_THAT(sink->values["temp"], ElementsAre(215));
}

TEST_F(InvalidValuesTest, There_is_another_revision_when_a_value_comes_and_goes_but_not_while_it_stays_away) {
  read("    temp: {address: 0, type: INT, invalid: 0x8000}\n");
  run_for(milliseconds(50));
  std::uint64_t revision = engine->revision();
  const auto is_another = [&] { return engine->revision() != std::exchange(revision, engine->revision()); };
  set(0, 0x8000);
  run_for(milliseconds(100));
  EXPECT_TRUE(is_another());
  run_for(milliseconds(500));
  EXPECT_FALSE(is_another());
  set(0, 1);
  run_for(milliseconds(100));
  EXPECT_TRUE(is_another());
}

TEST_F(InvalidValuesTest, A_value_that_stays_away_does_not_become_stale_while_it_is_read) {
  read("    temp: {address: 0, type: INT, invalid: 0x8000}\n");
  set(0, 0x8000);
  run_for(std::chrono::seconds(20));
  EXPECT_EQ(quality("temp").state, State::invalid);
  EXPECT_LT(quality("temp").stale_from, Time::max());
  clock.sleep_until(quality("temp").stale_from + milliseconds(1));
  EXPECT_EQ(quality("temp").state, State::stale);
  EXPECT_EQ(value("temp"), "-");
}

TEST_F(InvalidValuesTest, Bits_wide_values_halves_and_arrays_have_them_too) {
  read(
      "    bit: {address: 0, type: BOOL, bit: 3, invalid: 0xFFFF}\n"
      "    wide: {address: 1, type: DINT, invalid: -2147483648}\n"
      "    half: {address: 3, type: USINT, offset: high, invalid: 255}\n"
      "    other: {address: 3, type: USINT, offset: low, invalid: 255}\n"
      "    several: {address: 4, type: UINT, count: 3, invalid: [[0xFFF0, 0xFFFF]]}\n"
      "    real: {address: 8, type: REAL, order: ABCD, invalid: nan}\n");
  set(0, 0xFFFF);
  set(2, 0x8000);
  set(3, 0xFF07);
  set(5, 0xFFF1);
  set(8, 0x7FBF);
  set(9, 0xFF80);
  run_for(milliseconds(50));
  for (const char* point : {"bit", "wide", "half", "several", "real"})
    EXPECT_EQ(quality(point).state, State::invalid) << point;
  EXPECT_EQ(value("other"), "7");
  EXPECT_THAT(quality("several").why, HasSubstr("0xFFF1 as element 1"));
  set(0, 0x0008);
  set(2, 0);
  set(3, 0x01FF);
  set(5, 0);
  set(8, 0xFF80);  // minus infinity
  set(9, 0);
  run_for(milliseconds(100));
  for (const char* point : {"bit", "wide", "half", "several", "real"})
    EXPECT_EQ(quality(point).state, State::good) << point;
  EXPECT_EQ(quality("other").state, State::invalid);
  EXPECT_EQ(value("bit"), "true");
  EXPECT_EQ(value("real"), "-inf");
}

TEST_F(InvalidValuesTest, An_exponent_is_read_in_the_same_request_across_what_is_between) {
  read(
      "    power: {address: 0, type: INT, scale: {exponent_of: power_sf}}\n"
      "    power_sf: {address: 40, type: INT, invalid: 0x8000}\n");
  set(0, 1234);
  set(40, static_cast<std::uint16_t>(-2));
  run_for(milliseconds(50));
  EXPECT_EQ(device.count("read input_registers 0+41"), 1U);
  EXPECT_EQ(value("power"), "12.34");
  set(40, 3);
  run_for(milliseconds(100));
  EXPECT_EQ(value("power"), "1234000");
  EXPECT_THAT(sink->values["power"], ElementsAre(1234, 1234));
}

TEST_F(InvalidValuesTest, A_value_is_none_while_its_exponent_is_none) {
  read(
      "    power: {address: 0, type: INT, scale: {exponent_of: power_sf}, invalid: 0x8000}\n"
      "    power_sf: {address: 1, type: INT, invalid: 0x8000}\n");
  set(0, 5);
  set(1, 0x8000);
  run_for(milliseconds(50));
  EXPECT_EQ(quality("power").state, State::invalid);
  EXPECT_EQ(quality("power").why, "power_sf, the exponent of its scale, has no value");
  set(1, 31);
  run_for(milliseconds(100));
  EXPECT_EQ(quality("power").why, "power_sf is 31, which is out of range for an exponent (-30 to 30)");
  set(0, 0x8000);
  set(1, 1);
  run_for(milliseconds(100));
  EXPECT_EQ(quality("power").why, "the device gives 0x8000, which the map calls invalid");
  EXPECT_THAT(sink->values["power"], IsEmpty());
  set(0, 5);
  run_for(milliseconds(100));
  EXPECT_EQ(value("power"), "50");
}

/// The device gives only one register in a request.
TEST_F(InvalidValuesTest, A_value_waits_for_an_exponent_that_is_read_behind_it_in_the_same_cycle) {
  read(
      "    power: {address: 0, type: INT, scale: {exponent_of: power_sf}}\n"
      "    power_sf: {address: 200, type: INT}\n");
  set(0, 7);
  set(200, 1);
  run_for(milliseconds(50));
  EXPECT_EQ(value("power"), "70");
  // Both change between two cycles, and nobody sees one of them without the other.
  std::vector<std::string> seen;
  device.during_read = [&] { seen.push_back(value("power")); };
  set(0, 8);
  set(200, static_cast<std::uint16_t>(-1));
  run_for(milliseconds(100));
  EXPECT_THAT(seen, ElementsAre("70", "70"));
  EXPECT_EQ(value("power"), "0.8");
  EXPECT_THAT(sink->values["power"], ElementsAre(7, 8));
}

TEST_F(InvalidValuesTest, An_exponent_that_the_device_refuses_takes_the_value_with_it) {
  read(
      "    power_sf: {address: 0, type: INT}\n"
      "    power: {address: 200, type: INT, scale: {exponent_of: power_sf}}\n"
      "    early: {address: 0, type: INT, scale: {exponent_of: late_sf}}\n"
      "    late_sf: {address: 300, type: INT}\n");
  device.refuses = [](const std::string& request) -> std::optional<modbus::Exception> {
    if (request == "read input_registers 200+1") return std::nullopt;
    return modbus::Exception::server_device_busy;
  };
  run_for(milliseconds(250));
  EXPECT_EQ(quality("power").state, State::invalid);
  device.refuses = nullptr;
  run_for(milliseconds(200));
  EXPECT_EQ(quality("power").state, State::good);
  EXPECT_EQ(quality("early").state, State::good);
}

TEST_F(InvalidValuesTest, What_waits_when_the_connection_ends_is_forgotten) {
  read(
      "    power: {address: 0, type: INT, scale: {exponent_of: power_sf}}\n"
      "    power_sf: {address: 200, type: INT}\n");
  run_for(milliseconds(50));
  set(0, 7);
  device.refuses = [&](const std::string& request) -> std::optional<modbus::Exception> {
    if (request == "read input_registers 200+1") device.next_errors.push_back(TransportFailure{"reset"});
    return std::nullopt;
  };
  run_for(milliseconds(100));
  device.refuses = nullptr;
  sink->values.clear();
  set(0, 9);
  run_for(std::chrono::seconds(3));
  EXPECT_EQ(value("power"), "9");
  EXPECT_EQ(sink->values["power"].front(), 9);
}

TEST_F(InvalidValuesTest, An_exponent_is_read_with_each_value_that_is_wanted_whatever_the_rates) {
  read(
      "    power: {address: 0, type: INT, rate: 50, scale: {exponent_of: power_sf}}\n"
      "    power_sf: {address: 1, type: INT, rate: 1}\n"
      "    slow: {address: 2, type: INT, rate: 2, scale: {exponent_of: power_sf}}\n");
  engine->want(index("power_sf"), false);
  engine->want(index("slow"), false);
  set(0, 7);
  run_for(milliseconds(500));
  EXPECT_GT(device.count("read input_registers 0+2"), 20U);
  EXPECT_EQ(device.count("read input_registers 1+2"), 0U);
  EXPECT_EQ(value("power"), "7");
  engine->want(index("slow"), true);
  engine->want(index("power"), false);
  run_for(milliseconds(500));
  device.requests.clear();
  run_for(milliseconds(1000));
  EXPECT_EQ(device.count("read input_registers 0+2"), 0U);
  EXPECT_EQ(device.count("read input_registers 1+2"), 2U);
  engine->want(index("slow"), false);
  run_for(milliseconds(1000));
  device.requests.clear();
  run_for(milliseconds(1000));
  EXPECT_EQ(device.requests.size(), 0U);
}

TEST_F(InvalidValuesTest, A_value_that_waited_in_vain_is_not_joined_with_the_exponent_of_another_cycle) {
  read(
      "    power: {address: 0, type: INT, scale: {exponent_of: power_sf}}\n"
      "    power_sf: {address: 200, type: INT}\n");
  std::string refused = "read input_registers 200+1";
  device.refuses = [&](const std::string& request) -> std::optional<modbus::Exception> {
    if (request == refused) return modbus::Exception::server_device_busy;
    return std::nullopt;
  };
  set(0, 111);
  set(200, 3);
  run_for(milliseconds(50));
  refused = "read input_registers 0+1";
  run_for(milliseconds(100));
  EXPECT_THAT(sink->values["power"], IsEmpty());
  EXPECT_EQ(quality("power").state, State::exception);
  refused.clear();
  run_for(milliseconds(200));
  EXPECT_EQ(value("power"), "111000");
}

TEST_F(InvalidValuesTest, A_value_is_back_in_the_cycle_in_which_its_exponent_is) {
  read(
      "    power: {address: 0, type: INT, scale: {exponent_of: power_sf}}\n"
      "    power_sf: {address: 200, type: INT, invalid: 0x8000}\n");
  set(0, 5);
  set(200, 0x8000);
  run_for(milliseconds(50));
  EXPECT_EQ(quality("power").state, State::invalid);
  set(200, 1);
  run_for(milliseconds(100));
  EXPECT_EQ(value("power"), "50");
}

TEST_F(InvalidValuesTest, The_first_value_differs_from_none) {
  read(
      "    power: {address: 0, type: INT, scale: {exponent_of: power_sf}}\n"
      "    power_sf: {address: 1, type: INT, invalid: 0x8000}\n"
      "    door: {address: 2, type: BOOL, bit: 3, invalid: 0xFFFF}\n");
  set(0, 5);
  set(1, 0x8000);
  set(2, 0xFFFF);
  run_for(milliseconds(50));
  set(1, 0);
  set(2, 0x0008);
  run_for(milliseconds(100));
  EXPECT_TRUE(table->differs(index("power")));
  EXPECT_TRUE(table->differs(index("door")));
  run_for(milliseconds(100));
  EXPECT_FALSE(table->differs(index("power")));
  EXPECT_FALSE(table->differs(index("door")));
}

TEST_F(InvalidValuesTest, A_raw_value_beyond_its_ends_is_a_fault) {
  read(
      "    bar: {address: 0, type: UINT, scale: {raw: [4000, 20000], value: [0, 10]}, fault_below: 3600, "
      "fault_above: "
      "21000, invalid: 0}\n"
      "    several: {address: 1, type: INT, count: 2, fault_below: -5}\n");
  set(0, 12000);
  run_for(milliseconds(50));
  EXPECT_EQ(value("bar"), "5");
  set(0, 3599);
  set(2, static_cast<std::uint16_t>(-6));
  run_for(milliseconds(100));
  EXPECT_EQ(quality("bar").state, State::fault);
  EXPECT_EQ(quality("bar").why, "the device gives 3599, below fault_below (3600)");
  EXPECT_EQ(quality("several").why, "the device gives -6 as element 1, below fault_below (-5)");
  EXPECT_EQ(value("bar"), "-");
  set(0, 21001);
  run_for(milliseconds(100));
  EXPECT_EQ(quality("bar").why, "the device gives 21001, above fault_above (21000)");
  set(0, 0);
  run_for(milliseconds(100));
  EXPECT_EQ(quality("bar").state, State::invalid);
  set(0, 3600);
  run_for(milliseconds(100));
  EXPECT_EQ(quality("bar").state, State::good);
  EXPECT_THAT(sink->values["bar"], ElementsAre(12000, 3600));
}

TEST_F(InvalidValuesTest, A_write_that_hides_a_value_is_no_news_about_one_that_is_none) {
  read("    temp: {address: 0, type: INT, invalid: 0x8000}\n");
  set(0, 0x8000);
  run_for(milliseconds(50));
  const std::uint64_t revision = table->revision();
  const std::uint32_t temp = index("temp");
  table->good({&temp, 1}, clock.now());
  EXPECT_EQ(table->revision(), revision);
}

TEST_F(InvalidValuesTest, A_value_is_good_in_each_cycle_in_which_its_exponent_behind_it_is_read) {
  read(
      "    power: {address: 0, type: INT, scale: {exponent_of: power_sf}}\n"
      "    power_sf: {address: 200, type: INT}\n");
  int asked = 0;
  device.refuses = [&](const std::string& request) -> std::optional<modbus::Exception> {
    if (request == "read input_registers 200+1" && ++asked % 2 == 1)
      return modbus::Exception::server_device_busy;
    return std::nullopt;
  };
  set(0, 5);
  run_for(milliseconds(50));
  EXPECT_EQ(quality("power").state, State::invalid);
  EXPECT_EQ(sink->no_values["power"], 1);
  run_for(milliseconds(100));
  EXPECT_EQ(quality("power").state, State::good);
  run_for(milliseconds(100));
  EXPECT_EQ(quality("power").state, State::invalid);
}

TEST_F(InvalidValuesTest, After_a_lost_connection_an_exponent_is_read_with_its_values_again) {
  read(
      "    power_sf: {address: 0, type: INT, rate: 1}\n"
      "    power: {address: 1, type: INT, rate: 10, scale: {exponent_of: power_sf}}\n"
      "    other: {address: 300, type: INT}\n");
  run_for(milliseconds(50));
  device.next_errors.push_back(TransportFailure{"reset"});
  run_for(std::chrono::seconds(5));
  for (const char* request : {"read input_registers 0+1", "read input_registers 0+2"}) {
    device.refuses = [&](const std::string& asked) -> std::optional<modbus::Exception> {
      if (asked == request) device.next_errors.push_back(TransportFailure{"reset"});
      return std::nullopt;
    };
    run_for(milliseconds(1500));
    device.refuses = nullptr;
    run_for(std::chrono::seconds(10));
    device.requests.clear();
    run_for(std::chrono::seconds(2));
    EXPECT_EQ(device.count("read input_registers 1+1"), 0U) << request;
    EXPECT_GT(device.count("read input_registers 0+2"), 15U) << request;
  }
}

TEST_F(InvalidValuesTest, A_device_that_ignores_what_lies_between_is_read_in_two_requests) {
  read(
      "    power: {address: 0, type: INT, scale: {exponent_of: power_sf}}\n"
      "    power_sf: {address: 40, type: INT}\n");
  set(0, 5);
  set(40, 1);
  device.refuses = [&](const std::string& request) -> std::optional<modbus::Exception> {
    if (request == "read input_registers 0+41") device.next_errors.push_back(Timeout{milliseconds(100)});
    return std::nullopt;
  };
  run_for(std::chrono::seconds(30));
  EXPECT_EQ(value("power"), "50");
  EXPECT_EQ(quality("power").state, State::good);
}

TEST_F(InvalidValuesTest, An_infinity_is_no_fault_beyond_an_end_that_the_map_does_not_have) {
  read("    real: {address: 0, type: REAL, order: ABCD, fault_above: 100}\n");
  set(0, 0xFF80);
  run_for(milliseconds(50));
  EXPECT_EQ(quality("real").state, State::good);
  set(0, 0x7F80);
  run_for(milliseconds(100));
  EXPECT_EQ(quality("real").state, State::fault);
}

}  // namespace
}  // namespace coupler::host
