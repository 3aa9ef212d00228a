// SPDX-License-Identifier: Apache-2.0
#include "coupler/device/analogue/iio.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <limits>
#include <set>
#include <sstream>
#include <vector>

namespace coupler::device {
namespace {

using Error = tl::unexpected<std::string>;

struct Device {
  std::string id;  ///< "iio:device0"
  std::string name;
  std::string label;
  std::string folder;

  std::string described() const { return name.empty() ? id : fmt::format("{} ({})", id, name); }
};

std::vector<Device> devices(const std::string& sysfs) {
  const std::string all = sysfs + "/bus/iio/devices/";
  std::vector<Device> found;
  for (const std::string& id : names_in(all, "iio:device"))
    found.push_back({id, read_text(all + id + "/name").value_or(""),
                     read_text(all + id + "/label").value_or(""), all + id + "/"});
  return found;
}

tl::expected<Device, std::string> find_device(const std::string& sysfs, std::string_view wanted) {
  const std::vector<Device> all = devices(sysfs);
  std::vector<const Device*> matching;
  std::string there;
  for (const Device& device : all) {
    if (device.id == wanted || device.name == wanted || device.label == wanted) matching.push_back(&device);
    there += (there.empty() ? "" : ", ") + device.described();
  }
  if (matching.size() == 1) return *matching.front();
  if (matching.size() > 1)
    return Error(fmt::format("'{}' is the name of {} and of {}; choose one by its number, as 'iio:device0'",
                             wanted, matching[0]->described(), matching[1]->described()));
  return Error(fmt::format(
      "there is no IIO device '{}' (by name, label or as 'iio:device0'); this machine has {}", wanted,
      there.empty() ? "none: is the driver of the chip loaded? (run with --sim to do without)" : there));
}

/// "voltage0" is a "voltage", "voltage1-voltage2" a "voltage-voltage", "accel_x" an "accel".
std::string type_of(std::string_view channel) {
  std::string type(channel.substr(0, channel.find('_')));
  type.erase(std::remove_if(type.begin(), type.end(), [](unsigned char c) { return std::isdigit(c) != 0; }),
             type.end());
  return type;
}

/// The kernel gives these in thousandths of their unit.
bool is_in_thousandths(const std::string& type) {
  static const std::set<std::string> types{"voltage", "altvoltage",       "current",         "power",
                                           "temp",    "humidityrelative", "positionrelative"};
  return types.count(type.substr(0, type.find('-'))) != 0;
}

struct Found {
  Device device;
  std::string direction;  ///< "in" or "out"
  std::string channel;
  std::string file;  ///< of the value

  std::string described() const { return fmt::format("{} {}put {}", device.described(), direction, channel); }
};

/// The channels' names, from those of their files.
std::string channels_of(const Device& device, const std::string& direction) {
  std::string names;
  for (const std::string& file : names_in(device.folder, direction + "_")) {
    const std::size_t end = file.rfind('_');
    if (file.substr(end) != "_raw" && file.substr(end) != "_input") continue;
    names += (names.empty() ? "" : ", ") + file.substr(direction.size() + 1, end - direction.size() - 1);
  }
  return names.empty() ? "none" : names;
}

tl::expected<Found, std::string> find_channel(const std::string& sysfs, const Iio& wanted,
                                              const std::string& direction) {
  const auto device = find_device(sysfs, wanted.device);
  if (!device) return Error(device.error());
  Found found{*device, direction, std::string(wanted.channel), {}};
  const std::vector<std::string> files = names_in(device->folder, direction + "_" + found.channel + "_");
  // A processed value is preferred: only the driver knows how it comes about.
  for (const char* kind : {"_input", "_raw"}) {
    const std::string name = direction + "_" + found.channel + kind;
    if (std::find(files.begin(), files.end(), name) == files.end()) continue;
    found.file = device->folder + name;
    return found;
  }
  return Error(fmt::format("{} has no {}put channel '{}'; it has {}", device->described(), direction,
                           wanted.channel, channels_of(*device, direction)));
}

/// An attribute of the channel, or the one that it shares with others of its type, its direction, its device.
double shared_number(const Found& found, const char* attribute, double otherwise) {
  const std::string& folder = found.device.folder;
  const std::string direction = found.direction + "_";
  for (const std::string& owner :
       {direction + found.channel + "_", direction + type_of(found.channel) + "_", direction, std::string()})
    if (const auto number = read_number(folder + owner + attribute)) return *number;
  return otherwise;
}

double unit_of(const Found& found) { return is_in_thousandths(type_of(found.channel)) ? 0.001 : 1; }

std::string cannot_open(const Found& found, int error) {
  return fmt::format("{} cannot be opened: {}{}", found.described(), std::strerror(error),
                     remedy_for(error, found.file));
}

/// Reads the limits from "[least step most]", or from a list.
std::pair<double, double> limits_of(const Found& found) {
  std::pair<double, double> limits{std::numeric_limits<std::int32_t>::min(),
                                   std::numeric_limits<std::int32_t>::max()};
  auto text = read_text(found.file + "_available");
  if (!text) return limits;
  std::replace_if(
      text->begin(), text->end(), [](char c) { return c == '[' || c == ']'; }, ' ');
  std::istringstream numbers(*text);
  double number = 0;
  if (!(numbers >> number)) return limits;
  limits = {number, number};
  while (numbers >> number) limits.second = number;
  return limits;
}

}  // namespace

tl::expected<double, int> IioInput::read() const {
  return file.read().map([&](double raw) { return (raw + offset) * gain; });
}

bool IioOutput::accepts(double value) const {
  const double raw = std::round(value / gain - offset);
  return raw >= least && raw <= most;
}

int IioOutput::drive(double value) const { return file.write(std::llround(value / gain - offset)); }

tl::expected<IioInput, std::string> open_iio_input(const std::string& sysfs, const Iio& wanted) {
  const auto found = find_channel(sysfs, wanted, "in");
  if (!found) return Error(found.error());
  auto file = Attribute::open(found->file, Attribute::For::reading);
  if (!file) return Error(cannot_open(*found, file.error()));
  IioInput input{found->device.id, found->described(), *std::move(file), unit_of(*found), 0};
  if (found->file.substr(found->file.rfind('_')) == "_raw") {
    input.gain *= shared_number(*found, "scale", 1);
    input.offset = shared_number(*found, "offset", 0);
  }
  return input;
}

tl::expected<IioOutput, std::string> open_iio_output(const std::string& sysfs, const Iio& wanted) {
  const auto found = find_channel(sysfs, wanted, "out");
  if (!found) return Error(found.error());
  auto file = Attribute::open(found->file, Attribute::For::writing);
  if (!file) return Error(cannot_open(*found, file.error()));
  const double gain = unit_of(*found) * shared_number(*found, "scale", 1);
  if (gain == 0 || !std::isfinite(gain))
    return Error(fmt::format("{} has no usable scale", found->described()));
  const auto [least, most] = limits_of(*found);
  return IioOutput{found->device.id,
                   found->described(),
                   *std::move(file),
                   gain,
                   shared_number(*found, "offset", 0),
                   least,
                   most};
}

}  // namespace coupler::device
