// SPDX-License-Identifier: Apache-2.0
#include "coupler/device/node/output_parts.hpp"

#include <algorithm>

namespace coupler::device {
namespace {

/// Empty: it is no analogue output.
std::string_view device_of_output(const Point& point) {
  if (point.table != Table::holding_registers || !is_analogue(point)) return {};
  return point.iio.present() ? point.iio.device : point.pwm.chip;
}

}  // namespace

OutputParts::OutputParts(ServingContext& context) : context_(context) {
  if (context_.analogue == nullptr) return;
  for (const Point& point : context_.map->points)
    if (const auto device = device_of_output(point);
        !device.empty() && std::find(devices_.begin(), devices_.end(), device) == devices_.end())
      devices_.push_back(device);
}

/// Calls `use` with each output of a part that has no lines.
template <class Use>
void OutputParts::each_of_device(std::size_t part, Use use) const {
  const std::string_view device = devices_[part - context_.wiring->output_groups()];
  for (const Point& point : context_.map->points)
    if (device_of_output(point) == device) use(point);
}

std::string OutputParts::name(std::size_t part) const {
  if (has_lines(part)) return context_.wiring->name_of_outputs(part);
  std::string name;
  each_of_device(part, [&](const Point& output) {
    name += name.empty() ? std::string(device_of_output(output)) + " (" : ", ";
    name += output.name;
  });
  return name + ")";
}

bool OutputParts::drive_safe(std::size_t part) {
  if (has_lines(part)) return context_.wiring->drive_safe(part);
  bool good = true;
  each_of_device(part, [&](const Point& output) {
    if (output.safe != Safe::hold) good &= context_.analogue->drive(output, true);
  });
  return good;
}

void OutputParts::give_up(std::size_t part) {
  if (has_lines(part)) return context_.wiring->give_up_outputs(part);
  if (context_.channels == nullptr) return;
  each_of_device(part, [&](const Point& output) { context_.channels->give_up(output); });
}

}  // namespace coupler::device
