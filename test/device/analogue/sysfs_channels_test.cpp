// SPDX-License-Identifier: Apache-2.0
#include "coupler/device/analogue/sysfs_channels.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <linux/capability.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <array>
#include <filesystem>
#include <stdexcept>
#include <thread>

#include "coupler/device/analogue/latest_sample.hpp"
#include "coupler/device/analogue/sampler.hpp"
#include "test/device/analogue/fake_sysfs.hpp"
#include "test/device/core/fake_log.hpp"
#include "test/fakes/map_builder.hpp"

namespace coupler::device {
namespace {

using codec::Type;
using std::chrono::microseconds;
using std::chrono::milliseconds;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

constexpr milliseconds soon{20000};

/// Input register 0: voltage0 of "adc"; holding registers 0: its DAC, 1: a PWM.
fakes::MapBuilder board() {
  fakes::MapBuilder map;
  map.add(Table::input_registers, "volts", 0, Type::INT, [](Point& p) { p.iio = {"adc", "voltage0"}; });
  map.add(Table::holding_registers, "setpoint", 0, Type::UINT, [](Point& p) { p.iio = {"adc", "voltage0"}; });
  map.add(Table::holding_registers, "fan", 1, Type::UINT, [](Point& p) {
    p.pwm = {"pwmchip0", 0, microseconds(40)};
  });
  return map;
}

struct ChannelsOfAMap : testing::Test {
  ChannelsOfAMap() {
    sysfs.add_iio();
    sysfs.add_pwm();
  }

  void open(MapPtr of) {
    map = std::move(of);
    auto opened = open_channels(map->map(), log, sysfs.root);
    ASSERT_TRUE(opened) << opened.error();
    channels = *std::move(opened);
  }
  std::string error(MapPtr of) {
    map = std::move(of);
    const auto opened = open_channels(map->map(), log, sysfs.root);
    return opened ? "" : opened.error();
  }
  const Point& point(std::string_view name) const { return *find(map->map(), name); }

  FakeSysfs sysfs;
  FakeLog log;
  MapPtr map;
  std::unique_ptr<SysfsChannels> channels;
};

TEST_F(ChannelsOfAMap, Are_none_without_analogue_points) {
  open(fakes::MapBuilder().many(Table::holding_registers, 0, 4).build());
  EXPECT_EQ(nullptr, channels);
}

TEST_F(ChannelsOfAMap, Are_left_as_they_are_until_they_are_driven) {
  sysfs.write(FakeSysfs::dac(), "77");
  open(board().build());
  EXPECT_EQ("77", sysfs.read(FakeSysfs::dac()));
  EXPECT_EQ("0", sysfs.read(FakeSysfs::pwm("enable")));
}

TEST_F(ChannelsOfAMap, Are_driven_in_their_own_units) {
  open(board().build());
  EXPECT_EQ(Channels::Outcome::done, channels->drive(point("setpoint"), 2));
  EXPECT_EQ(Channels::Outcome::done, channels->drive(point("fan"), 75));
  EXPECT_EQ("4000", sysfs.read(FakeSysfs::dac()));
  EXPECT_EQ("30000", sysfs.read(FakeSysfs::pwm("duty_cycle")));
}

TEST_F(ChannelsOfAMap, Accept_what_they_can_be_driven_to) {
  open(board().build());
  EXPECT_TRUE(channels->accepts(point("fan"), 100));
  EXPECT_FALSE(channels->accepts(point("fan"), 100.1));
  EXPECT_FALSE(channels->accepts(point("fan"), -0.1));
  EXPECT_FALSE(channels->accepts(point("setpoint"), 3));
}

TEST_F(ChannelsOfAMap, That_fail_are_logged_once_per_change) {
  open(board().build());
  sysfs.remove("class");
  EXPECT_EQ(Channels::Outcome::failed, channels->drive(point("fan"), 10));
  EXPECT_EQ(Channels::Outcome::failed, channels->drive(point("fan"), 20));
  sysfs.add_pwm();
  EXPECT_EQ(Channels::Outcome::done, channels->drive(point("fan"), 10));
  EXPECT_THAT(log.lines, ElementsAre(HasSubstr("pwmchip0 (fan) channel 0 failed: No such file or directory"),
                                     "pwmchip0 (fan) channel 0 works again"));
}

TEST_F(ChannelsOfAMap, That_were_given_up_are_not_driven_any_more_and_the_others_are) {
  open(board().build());
  channels->give_up(point("fan"));
  EXPECT_EQ(Channels::Outcome::failed, channels->drive(point("fan"), 75));
  EXPECT_EQ(Channels::Outcome::done, channels->drive(point("setpoint"), 2));
  EXPECT_EQ("0", sysfs.read(FakeSysfs::pwm("duty_cycle")));
  EXPECT_EQ("4000", sysfs.read(FakeSysfs::dac()));
}

TEST_F(ChannelsOfAMap, Are_sampled_while_there_is_a_sampler) {
  open(board().build());
  EXPECT_EQ(std::nullopt, channels->read(point("volts"), TimePoint::clock::now()));
  const Sampler sampler(*channels, milliseconds(1), soon);
  EXPECT_DOUBLE_EQ(0.4, channels->read(point("volts"), TimePoint::clock::now()).value_or(-1));
  sysfs.write("bus/iio/devices/iio:device0/in_voltage0_raw", "2200");
  double seen = 0;
  for (const auto end = TimePoint::clock::now() + soon; seen != 1 && TimePoint::clock::now() < end;) {
    std::this_thread::sleep_for(milliseconds(1));
    seen = channels->read(point("volts"), TimePoint::clock::now()).value_or(seen);
  }
  EXPECT_DOUBLE_EQ(1, seen);
  EXPECT_THAT(log.lines, IsEmpty());
}

TEST_F(ChannelsOfAMap, That_hold_no_number_cannot_be_read_and_say_so_once) {
  open(board().build());
  sysfs.write("bus/iio/devices/iio:device0/in_voltage0_raw", "none");
  const Sampler sampler(*channels, milliseconds(1), soon);
  for (int i = 0; i < 3; ++i)
    EXPECT_EQ(std::nullopt, channels->read(point("volts"), TimePoint::clock::now()));
  EXPECT_THAT(log.lines, ElementsAre(HasSubstr("iio:device0 (adc) input voltage0 failed: ")));
}

TEST_F(ChannelsOfAMap, That_cannot_be_had_are_all_told_in_one_run) {
  sysfs.remove("bus");
  EXPECT_THAT(error(board().build()), testing::MatchesRegex("point 'volts': .*\npoint 'setpoint': [^\n]*"));
}

TEST_F(ChannelsOfAMap, Have_initial_and_safe_values_that_they_can_be_driven_to) {
  auto wrong = board();
  const auto too_much = wrong.keep({101});
  wrong.add(Table::holding_registers, "second", 2, Type::UINT, [&](Point& p) {
    p.pwm = {"pwmchip0", 0, microseconds(40)};
    p.initial = too_much;
    p.safe = Safe::on;
    p.safe_value = too_much;
  });
  const std::string said = error(wrong.build());
  EXPECT_THAT(said,
              HasSubstr("point 'second': pwmchip0 (fan) channel 0 is already the channel of point 'fan'"));
  EXPECT_THAT(said, HasSubstr("initial value 101; set 'initial' to one in its range, 0 to 100 %"));
  EXPECT_THAT(said, HasSubstr("safe value 101"));
}

/// This thread may open what a file's mode permits, and root no more than that.
class WithoutOverride {
 public:
  WithoutOverride() {
    if (::syscall(SYS_capget, &header_, before_.data()) != 0) throw std::runtime_error("capget");
    auto now = before_;
    now[0].effective &= ~(1U << CAP_DAC_OVERRIDE | 1U << CAP_DAC_READ_SEARCH);
    if (::syscall(SYS_capset, &header_, now.data()) != 0) throw std::runtime_error("capset");
  }
  WithoutOverride(const WithoutOverride&) = delete;
  WithoutOverride& operator=(const WithoutOverride&) = delete;
  ~WithoutOverride() { EXPECT_EQ(::syscall(SYS_capset, &header_, before_.data()), 0); }

 private:
  __user_cap_header_struct header_{_LINUX_CAPABILITY_VERSION_3, 0};
  std::array<__user_cap_data_struct, _LINUX_CAPABILITY_U32S_3> before_{};
};

/// Two channels of a PWM chip. Only the first one's files are there, and may not be opened yet.
struct NewChannels : testing::Test {
  NewChannels() {
    sysfs.add_pwm();
    permit(false);
  }

  static fakes::MapBuilder fans() {
    fakes::MapBuilder map;
    for (const std::uint16_t channel : {std::uint16_t{0}, std::uint16_t{1}})
      map.add(Table::holding_registers, channel == 0 ? "first" : "second", channel, Type::UINT,
              [&](Point& p) {
                p.pwm = {"pwmchip0", channel, microseconds(40)};
              });
    return map;
  }
  void permit(bool may) const {
    namespace fs = std::filesystem;
    fs::permissions(sysfs.root + "/" + FakeSysfs::pwm("duty_cycle"),
                    may ? fs::perms::owner_read | fs::perms::owner_write : fs::perms::none);
  }
  /// Kernel and udev, as soon as the second channel is asked for.
  void give() const {
    const auto end = TimePoint::clock::now() + soon;
    while (sysfs.read("class/pwm/pwmchip0/export") != "1") {
      if (TimePoint::clock::now() > end) return;
      std::this_thread::sleep_for(milliseconds(1));
    }
    sysfs.write("class/pwm/pwmchip0/pwm1/duty_cycle", "0");
    permit(true);
  }

  WithoutOverride without_override;
  FakeSysfs sysfs;
  FakeLog log;
  MapPtr map = fans().build();
};

TEST_F(NewChannels, Are_all_asked_for_before_one_is_waited_for) {
  std::thread kernel([&] { give(); });
  const auto opened = open_channels(map->map(), log, sysfs.root, soon);
  kernel.join();
  EXPECT_TRUE(opened) << opened.error();
}

TEST_F(NewChannels, Are_not_waited_for_when_the_time_for_all_of_them_is_over) {
  const auto opened = open_channels(map->map(), log, sysfs.root, milliseconds(1));
  ASSERT_FALSE(opened);
  EXPECT_THAT(opened.error(),
              HasSubstr("point 'first': pwmchip0 (fan) channel 0 cannot be opened: Permission denied"));
}

TEST(SamplingPeriod, Is_that_of_the_map_within_limits) {
  EXPECT_EQ(milliseconds(100), Sampler::period_for(10));
  EXPECT_EQ(Sampler::shortest, Sampler::period_for(1e6));
  EXPECT_EQ(Sampler::longest, Sampler::period_for(0.001));
}

using Sample = tl::expected<double, int>;

struct LatestSampleTest : testing::Test {
  LatestSampleTest() { latest.begin(now); }
  TimePoint now{std::chrono::hours(1)};
  LatestSample latest;
};

TEST_F(LatestSampleTest, Is_not_there_before_the_first_conversion) {
  EXPECT_EQ(Sample(tl::unexpected(EAGAIN)), latest.get(now));
}

TEST_F(LatestSampleTest, Is_the_last_one) {
  latest.put(1.5, now);
  latest.put(2.5, now);
  EXPECT_EQ(Sample(2.5), latest.get(now));
}

TEST_F(LatestSampleTest, That_failed_is_an_error_until_one_succeeds) {
  latest.put(1.5, now);
  latest.put(tl::unexpected(EIO), now);
  EXPECT_EQ(Sample(tl::unexpected(EIO)), latest.get(now));
  latest.put(2.5, now);
  EXPECT_EQ(Sample(2.5), latest.get(now));
}

TEST_F(LatestSampleTest, Is_an_error_when_no_other_came_for_too_long) {
  latest.put(1.5, now);
  EXPECT_EQ(Sample(1.5), latest.get(now + LatestSample::timeout));
  const TimePoint late = now + LatestSample::timeout + std::chrono::milliseconds(1);
  EXPECT_EQ(Sample(tl::unexpected(ETIMEDOUT)), latest.get(late));
  latest.begin(late);
  EXPECT_EQ(Sample(tl::unexpected(EAGAIN)), latest.get(late));
}

}  // namespace
}  // namespace coupler::device
