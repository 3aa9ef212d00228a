// SPDX-License-Identifier: Apache-2.0
#include "coupler/device/analogue/iio.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "test/device/analogue/fake_sysfs.hpp"

namespace coupler::device {
namespace {

using testing::HasSubstr;

struct IioChannels : testing::Test {
  IioChannels() { sysfs.add_iio(); }

  double value(std::string_view channel) {
    const auto input = open_iio_input(sysfs.root, {"adc", channel});
    return input ? input->read().value_or(-1) : -1;
  }
  std::string error(std::string_view device, std::string_view channel) {
    const auto input = open_iio_input(sysfs.root, {device, channel});
    return input ? "" : input.error();
  }

  FakeSysfs sysfs;
};

TEST_F(IioChannels, Are_raw_plus_offset_times_scale_in_volts) { EXPECT_DOUBLE_EQ(0.4, value("voltage0")); }

TEST_F(IioChannels, Share_the_scale_of_their_type) {
  EXPECT_DOUBLE_EQ(1, value("voltage1"));
  sysfs.write("bus/iio/devices/iio:device0/in_voltage-voltage_scale", "500");
  EXPECT_DOUBLE_EQ(4, value("voltage1-voltage2"));
}

TEST_F(IioChannels, Share_the_scale_of_their_direction) {
  EXPECT_DOUBLE_EQ(120, value("illuminance0")) << "lux: not given in thousandths";
}

TEST_F(IioChannels, That_the_driver_processes_are_read_as_they_are) { EXPECT_DOUBLE_EQ(23.5, value("temp")); }

TEST_F(IioChannels, Follow_the_device) {
  const auto input = open_iio_input(sysfs.root, {"adc", "voltage0"});
  ASSERT_TRUE(input);
  sysfs.write("bus/iio/devices/iio:device0/in_voltage0_raw", "2200");
  EXPECT_DOUBLE_EQ(1, input->read().value());
}

TEST_F(IioChannels, Are_found_by_name_label_or_number_of_their_device) {
  for (const char* device : {"adc", "plant", "iio:device0"}) EXPECT_EQ("", error(device, "voltage0"));
}

TEST_F(IioChannels, Without_their_device_name_those_that_exist) {
  EXPECT_THAT(error("dac", "voltage0"), HasSubstr("no IIO device 'dac'"));
  EXPECT_THAT(error("dac", "voltage0"), HasSubstr("this machine has iio:device0 (adc)"));
  sysfs.remove("bus");
  EXPECT_THAT(error("adc", "voltage0"), HasSubstr("--sim"));
}

TEST_F(IioChannels, That_do_not_exist_name_those_that_do) {
  EXPECT_EQ(
      "iio:device0 (adc) has no input channel 'voltage7'; it has temp, voltage0, voltage1, illuminance0, "
      "voltage1-voltage2",
      error("adc", "voltage7"));
}

TEST_F(IioChannels, Of_two_devices_with_one_name_are_ambiguous) {
  sysfs.write("bus/iio/devices/iio:device1/name", "adc");
  EXPECT_THAT(error("adc", "voltage0"), HasSubstr("of iio:device0 (adc) and of iio:device1 (adc)"));
}

TEST_F(IioChannels, That_are_outputs_are_driven_by_their_nearest_raw_value) {
  const auto dac = open_iio_output(sysfs.root, {"adc", "voltage0"});
  ASSERT_TRUE(dac) << dac.error();
  EXPECT_EQ(0, dac->drive(1.25));
  EXPECT_EQ("2500", sysfs.read(FakeSysfs::dac()));
  EXPECT_EQ(0, dac->drive(0.0013));
  EXPECT_EQ("3", sysfs.read(FakeSysfs::dac()));
}

TEST_F(IioChannels, That_are_outputs_accept_what_the_device_has_raw_values_for) {
  const auto dac = open_iio_output(sysfs.root, {"adc", "voltage0"});
  ASSERT_TRUE(dac);
  EXPECT_TRUE(dac->accepts(0));
  EXPECT_TRUE(dac->accepts(2.0475));
  EXPECT_FALSE(dac->accepts(2.048));
  EXPECT_FALSE(dac->accepts(-0.001));
  EXPECT_FALSE(dac->accepts(1e300));
}

TEST_F(IioChannels, That_cannot_be_driven_give_the_error) {
  sysfs.break_file(FakeSysfs::dac());
  const auto dac = open_iio_output(sysfs.root, {"adc", "voltage0"});
  ASSERT_TRUE(dac);
  EXPECT_EQ(ENOSPC, dac->drive(1));
}

}  // namespace
}  // namespace coupler::device
