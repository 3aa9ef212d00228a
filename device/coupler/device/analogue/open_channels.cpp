// SPDX-License-Identifier: Apache-2.0
#include "coupler/device/analogue/open_channels.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <map>
#include <utility>

#include "coupler/device/core/analogue_points.hpp"

namespace coupler::device {
namespace {

double initial_value_of(const Point& output) {
  constexpr std::array<std::uint16_t, 4> zero{};
  return codec::published(output.initial.empty() ? zero.data() : output.initial.data(), output.format,
                          output.scale);
}

/// Finds, and collects what went wrong so that one run tells everything.
class Opener {
 public:
  Opener(const Map& map, const std::string& sysfs) : sysfs_(sysfs) {
    for (const Point& point : map.points) {
      if (!is_analogue(point)) continue;
      if (point.table == Table::input_registers)
        take(point, inputs_, open_iio_input(sysfs_, point.iio));
      else if (point.iio.present())
        take(point, outputs_, open_iio_output(sysfs_, point.iio));
      else
        take(point, outputs_, PwmOutput::open(sysfs_, point.pwm));
    }
    for (const WiredOutput& output : outputs_) check(output);
  }

  tl::expected<std::unique_ptr<SysfsChannels>, std::string> finish(Log& log) {
    if (!errors_.empty()) return tl::unexpected(std::move(errors_));
    if (inputs_.empty() && outputs_.empty()) return nullptr;
    return std::make_unique<SysfsChannels>(sysfs_, std::move(inputs_), std::move(outputs_), log);
  }

 private:
  void error(const Point& point, const std::string& text) {
    errors_ += fmt::format("{}point '{}': {}", errors_.empty() ? "" : "\n", point.name, text);
  }

  template <class Wired, class Channel>
  void take(const Point& point, std::vector<Wired>& wired, tl::expected<Channel, std::string> channel) {
    if (channel)
      wired.push_back({&point, *std::move(channel)});
    else
      error(point, channel.error());
  }

  void check(const WiredOutput& output) {
    const Point& point = *output.point;
    const auto [other, is_new] = users_.emplace(name_of(output), &point);
    if (!is_new)
      error(point, fmt::format("{} is the channel of point '{}' too; give one of them another", other->first,
                               other->second->name));
    check(output, "initial", initial_value_of(point));
    if (point.safe != Safe::hold) check(output, "safe", safe_value_of(point));
  }

  void check(const WiredOutput& output, const char* which, double value) {
    if (std::isfinite(value) && accepts(output, value)) return;
    error(*output.point, fmt::format("{} cannot be driven to its {} value {}; set '{}' to one in its range{}",
                                     name_of(output), which, value, which,
                                     output.point->pwm.present() ? ", 0 to 100 %" : ""));
  }

  const std::string& sysfs_;
  std::vector<WiredInput> inputs_;
  std::vector<WiredOutput> outputs_;
  std::map<std::string, const Point*> users_;
  std::string errors_;
};

}  // namespace

tl::expected<std::unique_ptr<SysfsChannels>, std::string> open_channels(const Map& map, Log& log,
                                                                        const std::string& sysfs) {
  return Opener(map, sysfs).finish(log);
}

}  // namespace coupler::device
