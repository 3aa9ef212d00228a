// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fcntl.h>
#include <unistd.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>

#include "coupler/base/descriptor.hpp"

namespace coupler::device {

/// A folder with ordinary files where a kernel would have its own: they take every value.
class FakeSysfs {
 public:
  FakeSysfs() {
    std::string name = (std::filesystem::temp_directory_path() / "coupler-sysfs-XXXXXX").string();
    root = ::mkdtemp(name.data());
  }
  FakeSysfs(const FakeSysfs&) = delete;
  FakeSysfs& operator=(const FakeSysfs&) = delete;
  ~FakeSysfs() { std::filesystem::remove_all(root); }

  /// `path` is below the root. Who reads meanwhile sees a value, and never none.
  void write(const std::string& path, const std::string& text) const {
    const std::filesystem::path file = root + "/" + path;
    std::filesystem::create_directories(file.parent_path());
    const Descriptor all(::open(file.c_str(), O_WRONLY | O_CREAT | O_CLOEXEC, 0644));
    const std::string line = text + "\n";
    if (::pwrite(all.get(), line.data(), line.size(), 0) != static_cast<ssize_t>(line.size()) ||
        ::ftruncate(all.get(), static_cast<off_t>(line.size())) != 0)
      throw std::runtime_error("cannot write " + file.string());
  }
  /// The first line, which is what was written last.
  std::string read(const std::string& path) const {
    std::ifstream file(root + "/" + path);
    std::string line;
    std::getline(file, line);
    return line;
  }
  void remove(const std::string& path) const { std::filesystem::remove_all(root + "/" + path); }
  void link(const std::string& path, const std::string& to) const {
    const std::filesystem::path file = root + "/" + path;
    std::filesystem::create_directories(file.parent_path());
    std::filesystem::remove(file);
    std::filesystem::create_symlink(to, file);
  }
  /// Whether it was written since.
  void age(const std::string& path) const {
    std::filesystem::last_write_time(root + "/" + path,
                                     std::filesystem::file_time_type::clock::now() - std::chrono::hours(48));
  }
  bool is_aged(const std::string& path) const {
    return std::filesystem::last_write_time(root + "/" + path) < long_ago();
  }
  /// Writing to it fails with ENOSPC.
  void break_file(const std::string& path) const { link(path, "/dev/full"); }

  /// Device 0 is an ADC with the name "adc", with a DAC of 12 bits.
  void add_iio() const {
    const std::string device = "bus/iio/devices/iio:device0/";
    write(device + "name", "adc");
    write(device + "label", "plant");
    write(device + "in_voltage0_raw", "1000");
    write(device + "in_voltage0_scale", "0.5");
    write(device + "in_voltage0_offset", "-200");
    write(device + "in_voltage1_raw", "4");
    write(device + "in_voltage1-voltage2_raw", "8");
    write(device + "in_voltage_scale", "250");
    write(device + "in_temp_input", "23500");
    write(device + "in_illuminance0_raw", "12");
    write(device + "in_scale", "10");
    write(device + "out_voltage0_raw", "0");
    write(device + "out_voltage0_scale", "0.5");
    write(device + "out_voltage0_raw_available", "[0 1 4095]");
  }
  /// Chip 0 of the device "fan", with two channels, the first of them exported.
  void add_pwm() const {
    const std::string chip = "class/pwm/pwmchip0/";
    write(chip + "npwm", "2");
    link(chip + "device", "../../../fan");
    write(chip + "export", "");
    write(chip + "pwm0/period", "0");
    write(chip + "pwm0/duty_cycle", "0");
    write(chip + "pwm0/enable", "0");
  }
  static std::string dac() { return "bus/iio/devices/iio:device0/out_voltage0_raw"; }
  static std::string pwm(const char* file) { return std::string("class/pwm/pwmchip0/pwm0/") + file; }

  std::string root;

 private:
  static std::filesystem::file_time_type long_ago() {
    return std::filesystem::file_time_type::clock::now() - std::chrono::hours(24);
  }
};

}  // namespace coupler::device
