// SPDX-License-Identifier: Apache-2.0
// What is asked of the port's driver. A pseudo terminal has neither parity nor RS-485: the calls are
// recorded.
#include "coupler/host/modbus/serial_port.hpp"

#include <gmock/gmock.h>
#include <linux/serial.h>
#include <sys/file.h>
#include <sys/ioctl.h>
#include <sys/syscall.h>
#include <termios.h>

#include <cstdarg>
#include <filesystem>
#include <optional>

#include "test/host/modbus/serial_line.hpp"

namespace {

/// What the driver of a port was asked for since the last reset.
struct {
  std::optional<termios> settings;
  tcflag_t lost = 0;  ///< what it leaves out of the settings, as a driver may that has not all
  bool has_rs485 = true;
  bool rs485 = false;
  bool exclusive = false;
  int refusal = 0;  ///< of tcsetattr()
} driver;

}  // namespace

// In place of the C library's, also for libmodbus.
extern "C" int tcsetattr(int fd, int /*actions*/, const termios* settings) noexcept {
  if (driver.refusal != 0) return errno = driver.refusal, -1;
  if (!driver.settings) driver.settings = *settings;  // the last call restores the former ones
  return ::isatty(fd) == 1 ? 0 : -1;
}

extern "C" int tcgetattr(int /*fd*/, termios* settings) noexcept {
  *settings = driver.settings.value_or(termios{});
  settings->c_cflag &= ~driver.lost;
  return 0;
}

extern "C" int ioctl(int fd, unsigned long request, ...) noexcept {
  va_list rest;
  va_start(rest, request);
  void* argument = va_arg(rest, void*);
  va_end(rest);
  if (request == TIOCGRS485) return driver.has_rs485 ? 0 : (errno = ENOTTY, -1);
  if (request == TIOCSRS485) {
    if (!driver.has_rs485) return errno = ENOTTY, -1;
    driver.rs485 = (static_cast<serial_rs485*>(argument)->flags & SER_RS485_ENABLED) != 0;
    return 0;
  }
  if (request == TIOCEXCL) driver.exclusive = true;
  if (request == TIOCNXCL) driver.exclusive = false;
  return static_cast<int>(::syscall(SYS_ioctl, fd, request, argument));
}

namespace coupler::host {
namespace {

using ::testing::HasSubstr;

struct SerialPortTest : testing::Test {
  SerialPortTest() { driver = {}; }
  ~SerialPortTest() override { driver = {}; }
  Result<SerialPort> open() const { return SerialPort::open(settings); }
  std::string refusal() const {
    const auto port = open();
    return port ? "opened" : to_string(port.error());
  }

  test::SerialLine line{[](const test::Octets&) { return test::Octets(); }};
  Serial settings{line.device()};
};

TEST_F(SerialPortTest, The_port_is_set_as_the_specification_has_it) {
  ASSERT_TRUE(open());
  const tcflag_t flags = driver.settings->c_cflag;
  EXPECT_EQ(::cfgetospeed(&*driver.settings), B19200);
  EXPECT_EQ(flags & CSIZE, CS8);
  EXPECT_EQ(flags & (PARENB | PARODD), PARENB);
  EXPECT_EQ(flags & CSTOPB, 0U);
  EXPECT_EQ(driver.settings->c_lflag & (ICANON | ECHO), 0U);
  EXPECT_FALSE(driver.rs485);
}

TEST_F(SerialPortTest, Each_setting_is_made) {
  settings.baud = 115200;
  settings.parity = Serial::Parity::odd;
  settings.stop_bits = 2;
  settings.rs485 = true;
  const auto port = open();
  ASSERT_TRUE(port);
  EXPECT_EQ(::cfgetospeed(&*driver.settings), B115200);
  EXPECT_EQ(driver.settings->c_cflag & (PARENB | PARODD), PARENB | PARODD);
  EXPECT_NE(driver.settings->c_cflag & CSTOPB, 0U);
  EXPECT_TRUE(driver.rs485);
}

TEST_F(SerialPortTest, Every_rate_that_a_map_may_have_is_one_of_libmodbus) {
  for (const std::uint32_t rate : serial_rates) {
    driver = {};
    settings.baud = rate;
    ASSERT_TRUE(open()) << rate;
    EXPECT_EQ(::cfgetospeed(&*driver.settings) == B9600, rate == 9600) << rate;
  }
}

TEST_F(SerialPortTest, A_refused_setting_is_named) {
  settings.stop_bits = 2;
  for (const auto& [lost, name] : {std::pair<tcflag_t, const char*>{PARENB, "'parity: even'"},
                                   {CSTOPB, "'stop_bits: 2'"},
                                   {CBAUD, "'baud: 19200'"}}) {
    driver = {};
    driver.lost = lost;
    EXPECT_THAT(refusal(), HasSubstr(name));
  }
  driver = {};
  driver.refusal = EINVAL;
  EXPECT_THAT(refusal(), HasSubstr("19200 8E2: Invalid argument"));
}

TEST_F(SerialPortTest, A_driver_that_cannot_switch_the_direction_says_so) {
  driver.has_rs485 = false;
  settings.rs485 = true;
  EXPECT_THAT(refusal(), HasSubstr("leave 'rs485' out"));
}

TEST_F(SerialPortTest, The_port_is_its_own_until_it_is_closed) {
  {
    const auto port = open();
    ASSERT_TRUE(port);
    EXPECT_TRUE(driver.exclusive);
    EXPECT_THAT(refusal(), HasSubstr("uses it"));
  }
  EXPECT_FALSE(driver.exclusive);
  EXPECT_TRUE(open());
}

TEST_F(SerialPortTest, A_port_of_somebody_else_is_not_set) {
  const Descriptor other(::open(settings.device.data(), O_RDWR | O_NOCTTY | O_CLOEXEC));
  ASSERT_EQ(::flock(other.get(), LOCK_EX), 0);
  driver.settings.reset();
  EXPECT_THAT(refusal(), HasSubstr("uses it"));
  EXPECT_FALSE(driver.settings);
}

TEST_F(SerialPortTest, A_port_that_is_not_there_is_told_with_a_remedy) {
  settings.device = "/dev/ttyUSB_none";
  EXPECT_THAT(refusal(), HasSubstr("there is no such port"));
}

TEST_F(SerialPortTest, A_file_is_no_port) {
  settings.device = "/dev/null";
  EXPECT_THAT(refusal(), HasSubstr("/dev/null: it is no serial port"));
}

}  // namespace
}  // namespace coupler::host
