// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/modbus/serial_port.hpp"

#include <fcntl.h>
#include <modbus/modbus-rtu.h>
#include <sys/file.h>
#include <sys/ioctl.h>
#include <sys/stat.h>
#include <sys/sysmacros.h>
#include <termios.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "coupler/base/starts_with.hpp"
#include "coupler/map/fields.hpp"

namespace coupler::host {
namespace {

namespace fs = std::filesystem;

/// The ports of adapters, by the names that stay when they are plugged in elsewhere, or else as they are.
std::vector<std::string> ports_of_adapters() {
  std::vector<std::string> found;
  std::error_code none;
  for (fs::directory_iterator port("/dev/serial/by-id", none), end; !none && port != end;
       port.increment(none))
    found.push_back(port->path());
  if (!found.empty()) return found;
  for (fs::directory_iterator port("/dev", none), end; !none && port != end; port.increment(none)) {
    const std::string name = port->path().filename();
    if (starts_with(name, "ttyUSB") || starts_with(name, "ttyACM")) found.push_back(port->path());
  }
  return found;
}

/// The process that has a lock on the file (proc(5), /proc/locks); empty: none is known.
std::string locker_of(const std::string& device) {
  struct stat file {};
  if (::stat(device.c_str(), &file) != 0) return {};
  const std::string wanted =
      fmt::format("{:02x}:{:02x}:{}", major(file.st_dev), minor(file.st_dev), file.st_ino);
  std::ifstream locks("/proc/locks");
  for (std::string line; std::getline(locks, line);) {
    std::istringstream words(line);
    std::string number, kind, manner, access, pid, place;
    if (words >> number >> kind >> manner >> access >> pid >> place && place == wanted) return pid;
  }
  return {};
}

bool has_open(const fs::path& process, const fs::path& device) {
  std::error_code error;
  for (fs::directory_iterator fd(process / "fd", error), end; !error && fd != end; fd.increment(error)) {
    std::error_code gone;
    if (fs::read_symlink(fd->path(), gone) == device) return true;
  }
  return false;
}

/// The first other process that has the file open, whether it has a lock or not.
std::string opener_of(const std::string& device) {
  std::error_code error;
  const fs::path real = fs::canonical(device, error);
  if (error) return {};
  for (fs::directory_iterator process("/proc", error), end; !error && process != end;
       process.increment(error)) {
    std::string pid = process->path().filename();
    const bool is_number =
        std::all_of(pid.begin(), pid.end(), [](unsigned char c) { return std::isdigit(c) != 0; });
    if (is_number && pid != std::to_string(::getpid()) && has_open(process->path(), real)) return pid;
  }
  return {};
}

/// "process 1234 (coupler_driver)", another one that has the device file open; empty: this user may see none.
std::string holder_of(const std::string& device) {
  std::string pid = locker_of(device);
  if (pid == std::to_string(::getpid())) return {};
  std::string name;
  std::getline(std::ifstream(fs::path("/proc") / pid / "comm"), name);
  if (pid.empty() || name.empty()) {  // of a process that is not seen here, for instance outside a container
    pid = opener_of(device);
    std::getline(std::ifstream(fs::path("/proc") / pid / "comm"), name);
  }
  return pid.empty() ? std::string() : fmt::format("process {} ({})", pid, name);
}

std::string busy_text(const std::string& device) {
  const std::string holder = holder_of(device);
  return holder.empty()
             ? "another process uses it, or another map of this one that calls it by another name; "
               "give maps of one line the same 'device'"
             : holder +
                   " uses it; end it, or give several maps of one line to one driver: --maps a.yaml,b.yaml";
}

std::string open_text(const std::string& device, int error) {
  switch (error) {
    case ENOENT:
    case ENODEV:
    case ENXIO: {
      const auto ports = ports_of_adapters();
      return ports.empty() ? "there is no such port, nor one of another adapter; plug the adapter in"
                           : fmt::format("there is no such port; there are: {}", fmt::join(ports, ", "));
    }
    case EACCES:
      return "no permission; put the user into the group dialout (sudo usermod -aG dialout $USER), then log "
             "in again";
    case EBUSY: return busy_text(device);
    default: return std::strerror(error);
  }
}

tcflag_t parity_flags(Serial::Parity parity) {
  switch (parity) {
    case Serial::Parity::none: return 0;
    case Serial::Parity::even: return PARENB;
    case Serial::Parity::odd: return PARENB | PARODD;
  }
  return 0;
}

constexpr std::pair<std::uint32_t, speed_t> speeds[] = {
    {110, B110},       {300, B300},         {600, B600},         {1200, B1200},      {2400, B2400},
    {4800, B4800},     {9600, B9600},       {19200, B19200},     {38400, B38400},    {57600, B57600},
    {115200, B115200}, {230400, B230400},   {460800, B460800},   {500000, B500000},  {576000, B576000},
    {921600, B921600}, {1000000, B1000000}, {1152000, B1152000}, {1500000, B1500000}};

bool has_rate(const termios& is, std::uint32_t baud) {
  const auto* const found = std::find_if(std::begin(speeds), std::end(speeds),
                                         [baud](const auto& one) { return one.first == baud; });
  return found != std::end(speeds) && ::cfgetispeed(&is) == found->second &&
         ::cfgetospeed(&is) == found->second;
}

/// tcsetattr() is content when it could set a part.
std::string refused_setting(int fd, const Serial& wanted) {
  termios is{};
  if (::tcgetattr(fd, &is) != 0) return fmt::format("its settings cannot be read: {}", std::strerror(errno));
  if (!has_rate(is, wanted.baud)) return fmt::format("it does not take 'baud: {}'", wanted.baud);
  if ((is.c_cflag & (PARENB | PARODD)) != parity_flags(wanted.parity))
    return fmt::format("it does not take 'parity: {}'; try another one", to_string(wanted.parity));
  if (((is.c_cflag & CSTOPB) != 0) != (wanted.stop_bits == 2))
    return fmt::format("it does not take 'stop_bits: {}'", wanted.stop_bits);
  return {};
}

void close_port(_modbus* context) {
  if (modbus_rtu_get_serial_mode(context) == MODBUS_RTU_RS485)
    modbus_rtu_set_serial_mode(context, MODBUS_RTU_RS232);  // the driver would go on switching
  ::ioctl(modbus_get_socket(context), TIOCNXCL);
  modbus_close(context);
  modbus_free(context);
}

}  // namespace

Result<SerialPort> SerialPort::open(const Serial& settings) {
  const std::string device(settings.device);
  const auto refuse = [&](std::string_view why) {
    return fail(NotConnected{fmt::format("{}: {}", device, why)});
  };
  Descriptor lock(::open(device.c_str(), O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC));
  if (lock.get() < 0) return refuse(open_text(device, errno));
  if (::isatty(lock.get()) == 0)
    return refuse("it is no serial port; `ls /dev/serial/by-id` shows those of adapters");
  if (::flock(lock.get(), LOCK_EX | LOCK_NB) != 0) return refuse(busy_text(device));

  Context context(modbus_new_rtu(device.c_str(), static_cast<int>(settings.baud),
                                 parity_letter(settings.parity), 8, settings.stop_bits),
                  modbus_free);
  if (!context) return refuse(std::strerror(errno));
  if (modbus_connect(context.get()) != 0)
    return refuse(fmt::format("it cannot be set to {}: {}{}", rate_and_parity(settings), std::strerror(errno),
                              errno == EINVAL ? "; try another 'parity' or 'baud'" : ""));
  context = Context(context.release(), close_port);
  const int fd = modbus_get_socket(context.get());
  if (const auto refused = refused_setting(fd, settings); !refused.empty()) return refuse(refused);
  if (settings.rs485 && modbus_rtu_set_serial_mode(context.get(), MODBUS_RTU_RS485) != 0)
    return refuse(
        fmt::format("its driver cannot switch the direction of RS-485 ({}); leave 'rs485' out if the "
                    "adapter does it by itself",
                    std::strerror(errno)));
  ::ioctl(fd, TIOCEXCL);  // against programs that do not look at the lock
  return SerialPort(std::move(lock), std::move(context));
}

int SerialPort::fd() const { return modbus_get_socket(context_.get()); }

}  // namespace coupler::host
