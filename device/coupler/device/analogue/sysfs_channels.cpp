// SPDX-License-Identifier: Apache-2.0
#include "coupler/device/analogue/sysfs_channels.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cerrno>
#include <cmath>
#include <map>
#include <utility>

#include "coupler/device/core/analogue_points.hpp"

namespace coupler::device {
namespace {

/// Analogue points are few.
template <class Channels>
auto& channel_of(Channels& channels, const Point& point) {
  const auto found =
      std::find_if(channels.begin(), channels.end(), [&](const auto& c) { return c.wired.point == &point; });
  assert(found != channels.end());
  return *found;
}

double initial_value_of(const Point& output) {
  constexpr std::array<std::uint16_t, 4> zero{};
  return codec::published(output.initial.empty() ? zero.data() : output.initial.data(), output.format,
                          output.scale);
}

/// Opens channels, and collects the errors so that one run reports all of them.
class Opener {
 public:
  Opener(const Map& map, const std::string& sysfs, std::chrono::milliseconds timeout) : sysfs_(sysfs) {
    const TimePoint until = TimePoint::clock::now() + timeout;
    // Asks for all channels before it waits for one: udev cares for them meanwhile.
    for (const Point& point : map.points)
      if (point.pwm.present()) (void)PwmOutput::open(sysfs_, point.pwm);
    for (const Point& point : map.points) {
      if (!is_analogue(point)) continue;
      if (point.table == Table::input_registers)
        take(point, inputs_, open_iio_input(sysfs_, point.iio));
      else if (point.iio.present())
        take(point, outputs_, open_iio_output(sysfs_, point.iio));
      else
        take(point, outputs_, PwmOutput::open(sysfs_, point.pwm, until));
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
      error(point, fmt::format("{} is already the channel of point '{}'; give one of them another",
                               other->first, other->second->name));
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

bool accepts(const WiredOutput& output, double value) {
  if (const auto* dac = std::get_if<IioOutput>(&output.channel)) return dac->accepts(value);
  return is_duty_cycle(value);
}

const std::string& name_of(const WiredOutput& output) {
  if (const auto* dac = std::get_if<IioOutput>(&output.channel)) return dac->name;
  return std::get<PwmOutput>(output.channel).name();
}

SysfsChannels::SysfsChannels(std::string sysfs, std::vector<WiredInput> inputs,
                             std::vector<WiredOutput> outputs, Log& log)
    : sysfs_(std::move(sysfs)), errors_(inputs.size() + outputs.size()) {
  std::size_t next = 0;
  for (WiredInput& input : inputs) {
    Fault fault(input.channel.name, errors_[next++], log);
    inputs_.emplace_back(std::move(input), std::move(fault));
  }
  for (WiredOutput& output : outputs) {
    Fault fault(name_of(output), errors_[next++], log);
    outputs_.push_back({std::move(output), std::move(fault)});
  }
}

std::optional<double> SysfsChannels::read(const Point& point, TimePoint now) {
  Sampled& input = channel_of(inputs_, point);
  const auto sample = input.latest.get(now);
  // The first conversion is not finished: that is no fault.
  if (!sample && sample.error() == EAGAIN) return std::nullopt;
  if (!input.fault.note(sample ? 0 : sample.error())) return std::nullopt;
  return *sample;
}

bool SysfsChannels::accepts(const Point& point, double value) const {
  return device::accepts(channel_of(outputs_, point).wired, value);
}

bool SysfsChannels::is_plugged(const Point& point) const {
  return channel_of(outputs_, point).fault.error() != ENODEV;
}

Channels::Outcome SysfsChannels::drive(const Point& point, double value) {
  Driven& output = channel_of(outputs_, point);
  if (output.is_given_up) return Outcome::failed;
  const int error = std::visit([&](auto& channel) { return channel.drive(value); }, output.wired.channel);
  // Some drivers do not publish the limits of their DAC.
  const bool is_dac = std::holds_alternative<IioOutput>(output.wired.channel);
  if (is_dac && (error == EINVAL || error == ERANGE)) return Outcome::refused;
  if (output.fault.note(error)) return Outcome::done;
  return error == ENODEV ? Outcome::absent : Outcome::failed;
}

void SysfsChannels::give_up(const Point& point) { channel_of(outputs_, point).is_given_up = true; }

void SysfsChannels::hand_over(const SysfsChannels* successor) {
  const auto is_kept = [&](const WiredOutput& output) {
    return successor != nullptr &&
           std::any_of(successor->outputs_.begin(), successor->outputs_.end(),
                       [&](const Driven& other) { return name_of(other.wired) == name_of(output); });
  };
  for (const Driven& output : outputs_)
    if (const Point& point = *output.wired.point; !is_kept(output.wired) && point.safe != Safe::hold)
      (void)drive(point, safe_value_of(point));
}

std::vector<const Point*> SysfsChannels::reconnect() {
  std::vector<const Point*> reconnected;
  const auto replace = [&](auto& wired, auto again, Fault& fault) {
    if (!again) return;
    wired.channel = *std::move(again);
    // Otherwise a channel that is not used would be opened again and again.
    fault.note(0);
    reconnected.push_back(wired.point);
  };
  for (Sampled& input : inputs_)
    if (input.fault.error() == ENODEV)
      replace(input.wired, open_iio_input(sysfs_, input.wired.point->iio), input.fault);
  for (Driven& output : outputs_) {
    if (output.fault.error() != ENODEV) continue;
    const Point& point = *output.wired.point;
    if (point.iio.present())
      replace(output.wired, open_iio_output(sysfs_, point.iio), output.fault);
    else
      replace(output.wired, PwmOutput::open(sysfs_, point.pwm), output.fault);
  }
  return reconnected;
}

tl::expected<std::unique_ptr<SysfsChannels>, std::string> open_channels(const Map& map, Log& log,
                                                                        const std::string& sysfs,
                                                                        std::chrono::milliseconds timeout) {
  return Opener(map, sysfs, timeout).finish(log);
}

}  // namespace coupler::device
