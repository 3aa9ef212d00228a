// SPDX-License-Identifier: Apache-2.0
#include "coupler/device/analogue/sysfs_channels.hpp"

#include <algorithm>
#include <cassert>
#include <cerrno>
#include <utility>

#include "coupler/device/core/analogue_points.hpp"

namespace coupler::device {
namespace {

/// Analogue points are few.
template <class Channels, class PointOf>
std::size_t index_in(const Channels& channels, const Point& wanted, PointOf point_of) {
  const auto found =
      std::find_if(channels.begin(), channels.end(), [&](const auto& c) { return point_of(c) == &wanted; });
  assert(found != channels.end());
  return static_cast<std::size_t>(found - channels.begin());
}

}  // namespace

bool accepts(const WiredOutput& output, double value) {
  if (const auto* dac = std::get_if<IioOutput>(&output.channel)) return dac->accepts(value);
  return value >= 0 && value <= 100;
}

const std::string& name_of(const WiredOutput& output) {
  if (const auto* dac = std::get_if<IioOutput>(&output.channel)) return dac->name;
  return std::get<PwmOutput>(output.channel).name();
}

SysfsChannels::SysfsChannels(std::string sysfs, std::vector<WiredInput> inputs,
                             std::vector<WiredOutput> outputs, Log& log)
    : sysfs_(std::move(sysfs)), errors_(inputs.size() + outputs.size()), outputs_(std::move(outputs)) {
  faults_.reserve(inputs.size() + outputs_.size());
  for (WiredInput& input : inputs) {
    faults_.emplace_back(input.channel.name, errors_[faults_.size()], log);
    inputs_.emplace_back(std::move(input));
  }
  for (const WiredOutput& output : outputs_)
    faults_.emplace_back(name_of(output), errors_[faults_.size()], log);
}

std::optional<double> SysfsChannels::read(const Point& input, TimePoint now) {
  const std::size_t i = index_in(inputs_, input, [](const Sampled& s) { return s.wired.point; });
  const auto sample = inputs_[i].latest.get(now);
  // While the first conversion lasts, nothing is wrong with it.
  if (!sample && sample.error() == EAGAIN) return std::nullopt;
  if (!faults_[i].note(sample ? 0 : sample.error())) return std::nullopt;
  return *sample;
}

std::size_t SysfsChannels::index_of(const Point& output) const {
  return index_in(outputs_, output, [](const WiredOutput& wired) { return wired.point; });
}

bool SysfsChannels::accepts(const Point& output, double value) const {
  return device::accepts(outputs_[index_of(output)], value);
}

Channels::Outcome SysfsChannels::drive(const Point& output, double value) {
  const std::size_t i = index_of(output);
  const int error = std::visit([&](auto& channel) { return channel.drive(value); }, outputs_[i].channel);
  // Not every driver tells the limits of its DAC before.
  const bool is_dac = std::holds_alternative<IioOutput>(outputs_[i].channel);
  if (is_dac && (error == EINVAL || error == ERANGE)) return Outcome::refused;
  if (faults_[inputs_.size() + i].note(error)) return Outcome::done;
  return error == ENODEV ? Outcome::absent : Outcome::failed;
}

void SysfsChannels::hand_over(const SysfsChannels* successor) {
  const auto goes_on = [&](const WiredOutput& output) {
    return successor != nullptr &&
           std::any_of(successor->outputs_.begin(), successor->outputs_.end(),
                       [&](const WiredOutput& other) { return name_of(other) == name_of(output); });
  };
  for (const WiredOutput& output : outputs_)
    if (!goes_on(output) && output.point->safe != Safe::hold)
      (void)drive(*output.point, safe_value_of(*output.point));
}

std::vector<const Point*> SysfsChannels::mend() {
  std::vector<const Point*> mended;
  const auto replace = [&](const Point& point, auto& channel, auto again, Fault& fault) {
    if (!again) return;
    channel = *std::move(again);
    // Unless somebody asks for it, nobody else says so, and it would be found again and again.
    fault.note(0);
    mended.push_back(&point);
  };
  for (std::size_t i = 0; i < inputs_.size(); ++i) {
    WiredInput& input = inputs_[i].wired;
    if (errors_[i] == ENODEV)
      replace(*input.point, input.channel, open_iio_input(sysfs_, input.point->iio), faults_[i]);
  }
  for (std::size_t i = 0; i < outputs_.size(); ++i) {
    const Point& point = *outputs_[i].point;
    Fault& fault = faults_[inputs_.size() + i];
    if (errors_[inputs_.size() + i] != ENODEV) continue;
    if (point.iio.present())
      replace(point, outputs_[i].channel, open_iio_output(sysfs_, point.iio), fault);
    else
      replace(point, outputs_[i].channel, PwmOutput::open(sysfs_, point.pwm), fault);
  }
  return mended;
}

}  // namespace coupler::device
