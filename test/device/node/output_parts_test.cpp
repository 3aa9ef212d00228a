// SPDX-License-Identifier: Apache-2.0
#include "coupler/device/node/output_parts.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include "coupler/device/gpio/grouped_lines.hpp"
#include "coupler/device/supervisor/safety_processes.hpp"
#include "test/device/analogue/fake_sysfs.hpp"
#include "test/device/core/fake_log.hpp"
#include "test/fakes/map_builder.hpp"

namespace coupler::device {
namespace {

using codec::Type;
using testing::ElementsAre;

/// Lines on a bus that works, or hangs.
class BusOutputs : public OutputGroup {
 public:
  BusOutputs(std::string name, bool hangs) : name_(std::move(name)), hangs_(hangs) {}
  const std::string& name() const override { return name_; }
  int drive(Span<const int> levels) override {
    while (hangs_) ::pause();
    std::copy(levels.begin(), levels.end(), wires.all().begin());
    return 0;
  }
  int read(Span<int>) override { return 0; }

  SharedArray<int> wires{1, 1};

 private:
  std::string name_;
  bool hangs_;
};

class WiringOfGroups : public Wiring {
 public:
  explicit WiringOfGroups(Log& log) : groups({}, {}, log) {}
  Lines& lines() override { return groups; }
  Prepared prepare_next(const Map&, bool, Log&) override { return tl::unexpected(std::string()); }
  std::size_t output_groups() const override { return groups.output_groups(); }
  std::string name_of_outputs(std::size_t group) const override { return groups.name_of_outputs(group); }
  bool drive_safe(std::size_t group) override { return groups.drive_safe(group); }
  void give_up_outputs(std::size_t group) override { groups.give_up_outputs(group); }

  GroupedLines groups;
};

/// Coil 0 on an expander, whose bus hangs, and 1 on the board; two outputs of a DAC's device, and a PWM.
struct Outputs : testing::Test {
  Outputs() {
    sysfs.add_iio();
    sysfs.write("bus/iio/devices/iio:device0/out_voltage1_raw", "7");
    sysfs.add_pwm();
    auto channels = open_channels(map->map(), log, sysfs.root);
    EXPECT_TRUE(channels) << channels.error();
    auto wiring = std::make_unique<WiringOfGroups>(log);
    wiring->groups.add(WiredOutputs{expander, {{std::uint16_t{0}, Safe::off, 1}}});
    wiring->groups.add(WiredOutputs{board, {{std::uint16_t{1}, Safe::off, 1}}});
    context.map = &map->map();
    context.state = std::make_unique<SharedState>(map->map(), TimePoint());
    context.wiring = std::move(wiring);
    context.channels = *std::move(channels);
    context.analogue =
        std::make_unique<AnaloguePoints>(map->map(), context.state->image(), *context.channels);
    EXPECT_EQ(context.channels->drive(*find(map->map(), "setpoint"), 2), Channels::Outcome::done);
    EXPECT_EQ(context.channels->drive(*find(map->map(), "fan"), 50), Channels::Outcome::done);
  }

  static fakes::MapBuilder plant() {
    fakes::MapBuilder builder;
    builder.many(Table::coils, 0, 2);
    builder.add(Table::holding_registers, "setpoint", 0, Type::UINT, [](Point& p) {
      p.iio = {"adc", "voltage0"};
    });
    builder.add(Table::holding_registers, "fan", 1, Type::UINT, [](Point& p) {
      p.pwm = {"pwmchip0", 0, std::chrono::microseconds(40)};
    });
    builder.add(Table::holding_registers, "held", 2, Type::UINT, [](Point& p) {
      p.iio = {"adc", "voltage1"};
      p.safe = Safe::hold;
    });
    return builder;
  }
  std::vector<SafeOutcome> drive_all_safe() {
    std::vector<Child> lost;
    SafetyProcesses processes(lost);
    for (std::size_t part = 0; part < OutputParts(context).size(); ++part)
      EXPECT_TRUE(processes.start([&] { return OutputParts(context).drive_safe(part); }));
    return processes.finish();
  }

  FakeSysfs sysfs;
  FakeLog log;
  MapPtr map = plant().build();
  std::shared_ptr<BusOutputs> expander = std::make_shared<BusOutputs>("chip1 line 0", true);
  std::shared_ptr<BusOutputs> board = std::make_shared<BusOutputs>("chip0 line 5", false);
  ServingContext context;
};

TEST_F(Outputs, That_hang_keep_no_others_from_their_safe_state) {
  EXPECT_THAT(drive_all_safe(),
              ElementsAre(SafeOutcome::hangs, SafeOutcome::safe, SafeOutcome::safe, SafeOutcome::safe));
  EXPECT_EQ(board->wires[0], 0);
  EXPECT_EQ(sysfs.read(FakeSysfs::dac()), "0");
  EXPECT_EQ(sysfs.read(FakeSysfs::pwm("duty_cycle")), "0");
  EXPECT_EQ(sysfs.read("bus/iio/devices/iio:device0/out_voltage1_raw"), "7") << "it is to be held";
  std::vector<std::uint16_t> driven(2);
  context.wiring->lines().driven(modbus::Range::of(0, 2), driven);
  EXPECT_THAT(driven, ElementsAre(1, 0)) << "one of them is on yet";
}

TEST_F(Outputs, Are_named_by_what_is_behind_them) {
  const OutputParts parts(context);
  ASSERT_EQ(parts.size(), 4U);
  EXPECT_EQ(parts.name(0), "chip1 line 0");
  EXPECT_EQ(parts.name(1), "chip0 line 5");
  EXPECT_EQ(parts.name(2), "adc (setpoint, held)");
  EXPECT_EQ(parts.name(3), "pwmchip0 (fan)");
}

TEST_F(Outputs, That_were_given_up_fail_at_once) {
  OutputParts parts(context);
  parts.give_up(0);
  parts.give_up(3);
  EXPECT_FALSE(parts.drive_safe(0));
  EXPECT_TRUE(parts.drive_safe(1));
  EXPECT_TRUE(parts.drive_safe(2));
  EXPECT_FALSE(parts.drive_safe(3));
  EXPECT_EQ(sysfs.read(FakeSysfs::pwm("duty_cycle")), "20000") << "as it was";
}

}  // namespace
}  // namespace coupler::device
