// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/modbus/port_holder.hpp"

#include <sys/stat.h>
#include <sys/sysmacros.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <system_error>

#include <fmt/format.h>

namespace coupler::host {
namespace {

namespace fs = std::filesystem;

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

}  // namespace

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

}  // namespace coupler::host
