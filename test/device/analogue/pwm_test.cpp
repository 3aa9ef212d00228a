// SPDX-License-Identifier: Apache-2.0
#include "coupler/device/analogue/pwm.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "test/device/analogue/fake_sysfs.hpp"

namespace coupler::device {
namespace {

using std::chrono::microseconds;
using testing::HasSubstr;

struct PwmChannel : testing::Test {
  PwmChannel() { sysfs.add_pwm(); }

  tl::expected<PwmOutput, std::string> open(std::string_view chip = "pwmchip0", std::uint16_t channel = 0) {
    return PwmOutput::open(sysfs.root, {chip, channel, microseconds(40)});
  }
  std::string error(std::string_view chip, std::uint16_t channel) {
    const auto opened = open(chip, channel);
    return opened ? "" : opened.error();
  }
  std::string shown() {
    return sysfs.read(FakeSysfs::pwm("duty_cycle")) + " of " + sysfs.read(FakeSysfs::pwm("period")) + ", " +
           sysfs.read(FakeSysfs::pwm("enable"));
  }

  FakeSysfs sysfs;
};

TEST_F(PwmChannel, Is_left_as_it_is_until_it_is_driven) {
  sysfs.write(FakeSysfs::pwm("period"), "20000");
  EXPECT_TRUE(open());
  EXPECT_EQ("0 of 20000, 0", shown());
}

TEST_F(PwmChannel, Is_driven_in_percent_of_its_period) {
  auto pwm = open();
  ASSERT_TRUE(pwm) << pwm.error();
  EXPECT_EQ(0, pwm->drive(25));
  EXPECT_EQ("10000 of 40000, 1", shown());
  EXPECT_EQ(0, pwm->drive(100));
  EXPECT_EQ("40000 of 40000, 1", shown());
  EXPECT_EQ(0, pwm->drive(0.00126));
  EXPECT_EQ("1 of 40000, 1", shown());
}

TEST_F(PwmChannel, That_runs_already_gets_a_new_duty_cycle_and_nothing_else) {
  sysfs.write(FakeSysfs::pwm("duty_cycle"), "30000");
  sysfs.write(FakeSysfs::pwm("period"), "40000");
  sysfs.write(FakeSysfs::pwm("enable"), "1");
  for (const char* file : {"period", "enable"}) sysfs.age(FakeSysfs::pwm(file));
  auto pwm = open();
  ASSERT_TRUE(pwm) << pwm.error();
  EXPECT_EQ(0, pwm->drive(50));
  EXPECT_EQ("20000 of 40000, 1", shown());
  for (const char* file : {"period", "enable"}) EXPECT_TRUE(sysfs.is_aged(FakeSysfs::pwm(file))) << file;
}

TEST_F(PwmChannel, With_a_duty_cycle_above_the_new_period_is_shortened_first) {
  sysfs.write(FakeSysfs::pwm("duty_cycle"), "90000");
  sysfs.write(FakeSysfs::pwm("period"), "100000");
  auto pwm = open();
  ASSERT_TRUE(pwm);
  sysfs.remove(FakeSysfs::pwm("enable"));  // ends the start after the duty cycle and the period
  EXPECT_NE(0, pwm->drive(50));
  EXPECT_EQ("20000 of 40000, ", shown());
}

TEST_F(PwmChannel, Is_found_by_the_device_of_its_chip) { EXPECT_EQ("", error("fan", 0)); }

TEST_F(PwmChannel, That_nobody_has_asked_for_is_exported) {
  EXPECT_THAT(error("pwmchip0", 1), HasSubstr("pwmchip0 (fan) channel 1 cannot be opened"));
  EXPECT_EQ("1", sysfs.read("class/pwm/pwmchip0/export"));
}

TEST_F(PwmChannel, Without_its_chip_names_those_that_exist) {
  EXPECT_EQ(
      "there is no PWM chip 'pwmchip7' (by name, or the device that has it); this machine has pwmchip0 (fan) "
      "with 2 channels",
      error("pwmchip7", 0));
  sysfs.remove("class");
  EXPECT_THAT(error("pwmchip0", 0), HasSubstr("--sim"));
}

TEST_F(PwmChannel, That_the_chip_does_not_have_names_those_it_has) {
  EXPECT_EQ("pwmchip0 (fan) has no channel 2; it has channels 0 to 1", error("pwmchip0", 2));
}

TEST_F(PwmChannel, That_cannot_be_driven_gives_the_error) {
  sysfs.break_file(FakeSysfs::pwm("duty_cycle"));
  auto pwm = open();
  ASSERT_TRUE(pwm);
  EXPECT_NE(0, pwm->drive(10));
}

}  // namespace
}  // namespace coupler::device
