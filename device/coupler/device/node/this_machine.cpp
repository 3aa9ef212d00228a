// SPDX-License-Identifier: Apache-2.0
#include "coupler/device/node/this_machine.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <vector>

#include "coupler/base/descriptor.hpp"
#include "coupler/map/fingerprint.hpp"

namespace coupler::device {
namespace {

namespace fs = std::filesystem;

/// The content without the blanks, line end and zero (device tree) behind it; empty if it cannot be read.
/// O_NONBLOCK: nobody may let the node wait here.
std::string read_short(const std::string& path) {
  const Descriptor file(::open(path.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC));
  std::array<char, 256> buffer{};
  const auto size = file.is_open() ? ::read(file.get(), buffer.data(), buffer.size()) : 0;
  std::string text(buffer.data(), size > 0 ? static_cast<std::size_t>(size) : 0);
  const auto is_blank = [](char c) { return c == '\0' || c == ' ' || c == '\t' || c == '\n' || c == '\r'; };
  while (!text.empty() && is_blank(text.back())) text.pop_back();
  text.erase(text.begin(), std::find_if_not(text.begin(), text.end(), is_blank));
  return text;
}

/// Boards without a serial number have one of these in its place, and many boards have the same.
bool is_filler(std::string text) {
  for (char& c : text)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  constexpr std::array<std::string_view, 12> fillers{"none",
                                                     "n/a",
                                                     "na",
                                                     "unknown",
                                                     "default string",
                                                     "not specified",
                                                     "not applicable",
                                                     "not available",
                                                     "to be filled by o.e.m.",
                                                     "system serial number",
                                                     "123456789",
                                                     "0123456789"};
  return text.find_first_not_of("0.-: x") == std::string::npos ||
         std::find(fillers.begin(), fillers.end(), text) != fillers.end();
}

/// Returns whether the maker gave the address to this interface alone. Otherwise the bit "local" in the
/// second hexadecimal digit is set, and machines of one kind may all have the same address.
bool is_unique(const std::string& mac) {
  return mac.size() > 1 && std::string_view("014589cd").find(mac[1]) != std::string_view::npos;
}

/// Virtual interfaces have no device; an address that the kernel or somebody else made up is not permanent.
std::string first_permanent_mac(const std::string& root) {
  std::vector<std::string> interfaces;
  std::error_code error;
  fs::directory_iterator entry(root + "/sys/class/net", error);
  for (; !error && entry != fs::directory_iterator(); entry.increment(error))
    interfaces.push_back(entry->path());
  std::sort(interfaces.begin(), interfaces.end());
  for (const std::string& interface : interfaces) {
    if (!fs::exists(interface + "/device", error) || read_short(interface + "/addr_assign_type") != "0")
      continue;
    if (auto address = read_short(interface + "/address"); is_unique(address) && !is_filler(address))
      return address;
  }
  return {};
}

}  // namespace

std::string find_serial(const std::string& root) {
  for (const char* const board :
       {"/sys/firmware/devicetree/base/serial-number", "/proc/device-tree/serial-number",
        "/sys/class/dmi/id/product_serial", "/sys/class/dmi/id/board_serial"})
    if (auto serial = read_short(root + board); !is_filler(serial)) return serial;
  if (auto mac = first_permanent_mac(root); !mac.empty()) return mac;
  auto id = read_short(root + "/etc/machine-id");
  return id == "uninitialized" || is_filler(id) ? std::string() : id;
}

std::uint64_t hashed_serial(std::string_view serial) {
  return serial.empty() ? 0 : hash64("OpenCoupler serial: " + std::string(serial));
}

identity::Machine this_machine(const std::string& root) {
  std::array<char, sizeof identity::Machine::hostname + 1> name{};
  if (::gethostname(name.data(), name.size() - 1) != 0) name[0] = '\0';
  std::string hostname(name.data());
  std::replace_if(
      hostname.begin(), hostname.end(), [](char c) { return c <= ' ' || c > '~'; }, '?');
  return identity::machine_of(hostname, hashed_serial(find_serial(root)));
}

}  // namespace coupler::device
