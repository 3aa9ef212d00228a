// SPDX-License-Identifier: Apache-2.0
#include "coupler/device/analogue/pwm.hpp"

#include <fmt/format.h>

#include <cerrno>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <thread>

namespace coupler::device {
namespace {

using Error = tl::unexpected<std::string>;
namespace fs = std::filesystem;

constexpr std::chrono::milliseconds retry_interval{20};

struct Chip {
  std::string name;    ///< "pwmchip0"
  std::string device;  ///< what the chip belongs to: "fe20c000.pwm"
  unsigned channels = 0;
  std::string folder;

  std::string described() const { return device.empty() ? name : fmt::format("{} ({})", name, device); }
};

tl::expected<Chip, std::string> find_chip(const std::string& sysfs, std::string_view wanted) {
  const std::string all = sysfs + "/class/pwm/";
  std::string there;
  for (const std::string& name : names_in(all, "pwmchip")) {
    std::error_code error;
    Chip chip{name, fs::read_symlink(all + name + "/device", error).filename(),
              static_cast<unsigned>(read_number(all + name + "/npwm").value_or(0)), all + name + "/"};
    if (chip.name == wanted || chip.device == wanted) return chip;
    there += fmt::format("{}{} with {} channel{}", there.empty() ? "" : ", ", chip.described(), chip.channels,
                         chip.channels == 1 ? "" : "s");
  }
  return Error(fmt::format(
      "there is no PWM chip '{}' (by name, or the device that has it); this machine has {}", wanted,
      there.empty() ? "none: is it enabled in the device tree? (run with --sim to do without)" : there));
}

std::string failed(const std::string& what, const char* verb, int error, const std::string& path) {
  return fmt::format("{} cannot be {}: {}{}", what, verb, std::strerror(error),
                     error == EBUSY ? "; a driver of the kernel uses it: free it there or choose another"
                                    : remedy_for(error, path));
}

/// Returns 0 or an errno.
int write_once(const std::string& path, std::int64_t value) {
  const auto file = Attribute::open(path, Attribute::For::writing);
  return file ? file->write(value) : file.error();
}

tl::expected<Attribute, int> open_new(const std::string& path, TimePoint until) {
  auto file = Attribute::open(path, Attribute::For::writing);
  while (!file && file.error() == EACCES && TimePoint::clock::now() < until) {
    std::this_thread::sleep_for(retry_interval);
    file = Attribute::open(path, Attribute::For::writing);
  }
  return file;
}

}  // namespace

tl::expected<PwmOutput, std::string> PwmOutput::open(const std::string& sysfs, const Pwm& wanted,
                                                     TimePoint until) {
  const auto chip = find_chip(sysfs, wanted.chip);
  if (!chip) return Error(chip.error());
  if (wanted.channel >= chip->channels)
    return Error(
        fmt::format("{} has no channel {}; it has {}", chip->described(), wanted.channel,
                    chip->channels == 0 ? "none" : fmt::format("channels 0 to {}", chip->channels - 1)));
  const std::string name = fmt::format("{} channel {}", chip->described(), wanted.channel);
  const std::string folder = fmt::format("{}pwm{}/", chip->folder, wanted.channel);
  std::error_code missing;
  if (!fs::exists(folder, missing))
    if (const int error = write_once(chip->folder + "export", wanted.channel); error != 0)
      return Error(failed(name, "exported", error, chip->folder + "export"));
  auto duty = open_new(folder + "duty_cycle", until);
  if (!duty) return Error(failed(name, "opened", duty.error(), folder + "duty_cycle"));
  return PwmOutput(name, folder, *std::move(duty), wanted.period);
}

int PwmOutput::drive(double percent) {
  const auto duty =
      static_cast<std::int64_t>(std::llround(percent / 100 * static_cast<double>(period_.count())));
  if (is_started_) return duty_.write(duty);
  const int error = start(duty);
  is_started_ = error == 0;
  return error;
}

int PwmOutput::start(std::int64_t duty) {
  const auto runs_at = read_number(folder_ + "period");
  const auto runs_for = read_number(folder_ + "duty_cycle");
  if (!runs_at || !runs_for) return runs_at ? runs_for.error() : runs_at.error();
  // The kernel refuses a duty cycle above the period at any moment.
  const auto period = static_cast<double>(period_.count());
  const bool duty_first = *runs_for > period;
  if (duty_first)
    if (const int error = duty_.write(duty); error != 0) return error;
  if (*runs_at != period)
    if (const int error = write_once(folder_ + "period", period_.count()); error != 0) return error;
  if (!duty_first)
    if (const int error = duty_.write(duty); error != 0) return error;
  if (read_number(folder_ + "enable").value_or(0) == 1) return 0;
  return write_once(folder_ + "enable", 1);
}

}  // namespace coupler::device
