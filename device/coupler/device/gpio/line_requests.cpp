// SPDX-License-Identifier: Apache-2.0
#include "coupler/device/gpio/line_requests.hpp"

#include <algorithm>
#include <optional>
#include <utility>

#include "coupler/device/gpio/absent.hpp"
#include "coupler/device/gpio/backend.hpp"

namespace coupler::device {
namespace {

HeldRequest held(const std::vector<LineSpec>& lines) {
  HeldRequest held;
  for (const LineSpec& line : lines) {
    held.lines.push_back(held_as(line));
    held.points.push_back(line.point);
  }
  return held;
}

WiredOutputs wired_outputs(std::shared_ptr<OutputGroup> group, const std::vector<LineSpec>& lines,
                           bool readback) {
  WiredOutputs wired;
  wired.group = std::move(group);
  wired.readback = readback;
  for (const LineSpec& line : lines) {
    wired.addresses.emplace_back(line.point->address);
    wired.safe.push_back(line.point->safe);
    wired.levels.push_back(line.level);
  }
  return wired;
}

WiredInputs wired_inputs(backend::Inputs made, const std::vector<LineSpec>& lines) {
  WiredInputs wired;
  wired.group = std::move(made.group);
  wired.events = made.events;
  for (const LineSpec& line : lines) {
    wired.addresses.emplace_back(line.point->address);
    wired.counted |= line.counted.has_value() && made.events != nullptr;
  }
  return wired;
}

/// The lines that points of the map want of a request that was lost, where they are now. nullopt: not all of
/// them are there.
std::optional<std::vector<LineSpec>> find_again(const HeldRequest& held, const Inventory& inventory) {
  std::vector<LineSpec> found;
  for (std::size_t i = 0; i < held.lines.size(); ++i) {
    if (held.points[i] == nullptr) continue;
    const auto line = inventory.find(held.points[i]->line);
    if (!line) return std::nullopt;
    const LineSpec wanted{held.points[i], *line, held.lines[i].counted};
    if (!found.empty() && !backend::fits(found, wanted)) return std::nullopt;
    found.push_back(wanted);
  }
  if (found.empty()) return std::nullopt;
  return found;
}

}  // namespace

void LineRequests::release() {
  lines_.release();
  outputs_.clear();
  inputs_.clear();
}

void LineRequests::keep_outputs(WiredOutputs wired, HeldRequest held) {
  lines_.add(std::move(wired));
  outputs_.push_back(std::move(held));
}

void LineRequests::keep_inputs(WiredInputs wired, HeldRequest held) {
  lines_.add(std::move(wired));
  inputs_.push_back(std::move(held));
}

tl::expected<void, std::string> LineRequests::request(const std::vector<LineSpec>& lines, bool readback) {
  if (is_output(lines.front())) {
    auto group = backend::request_outputs(lines);
    if (!group) return tl::unexpected(std::move(group).error());
    keep_outputs(wired_outputs(*std::move(group), lines, readback), held(lines));
  } else {
    auto made = backend::request_inputs(lines);
    if (!made) return tl::unexpected(std::move(made).error());
    keep_inputs(wired_inputs(*std::move(made), lines), held(lines));
  }
  return {};
}

void LineRequests::add_missing(const std::vector<LineSpec>& lines, bool readback) {
  HeldRequest missing = held(lines);
  missing.lost = true;
  if (is_output(lines.front()))
    keep_outputs(wired_outputs(std::make_shared<AbsentOutputs>(names_of(lines)), lines, readback),
                 std::move(missing));
  else
    keep_inputs(wired_inputs({std::make_unique<AbsentInputs>(names_of(lines)), nullptr}, lines),
                std::move(missing));
}

bool LineRequests::mend(bool safe) {
  const bool lost = lose();
  return renew(safe) || lost;
}

bool LineRequests::lose() {
  bool any = false;
  for (std::size_t i = 0; i < outputs_.size(); ++i) {
    if (outputs_[i].lost || lines_.outputs(i).group->is_plugged()) continue;
    lines_.lose_outputs(i);
    outputs_[i].lost = any = true;
  }
  for (std::size_t i = 0; i < inputs_.size(); ++i) {
    if (inputs_[i].lost || lines_.inputs(i).group->is_plugged()) continue;
    lines_.lose_inputs(i);
    inputs_[i].lost = any = true;
  }
  return any;
}

bool LineRequests::renew(bool safe) {
  const auto is_lost = [](const HeldRequest& held) { return held.lost; };
  if (std::none_of(outputs_.begin(), outputs_.end(), is_lost) &&
      std::none_of(inputs_.begin(), inputs_.end(), is_lost))
    return false;
  const Inventory inventory = backend::chips();
  bool any = false;
  for (std::size_t i = 0; i < outputs_.size(); ++i)
    if (outputs_[i].lost)
      if (const auto lines = find_again(outputs_[i], inventory)) any |= renew_outputs(i, *lines, safe);
  for (std::size_t i = 0; i < inputs_.size(); ++i)
    if (inputs_[i].lost)
      if (const auto lines = find_again(inputs_[i], inventory)) any |= renew_inputs(i, *lines);
  return any;
}

bool LineRequests::renew_outputs(std::size_t group, const std::vector<LineSpec>& lines, bool safe) {
  std::vector<LineSpec> wanted = lines;
  for (LineSpec& line : wanted) {
    std::uint16_t level = 0;
    lines_.driven(range(*line.point), Span<std::uint16_t>(&level, 1));
    line.level = safe ? safe_level(line.point->safe, level) : level;
  }
  auto made = backend::request_outputs(wanted);
  if (!made) {
    refuse(outputs_[group], made.error());
    return false;
  }
  lines_.renew_outputs(group, wired_outputs(*std::move(made), wanted, lines_.outputs(group).readback));
  outputs_[group] = held(wanted);
  return true;
}

bool LineRequests::renew_inputs(std::size_t group, const std::vector<LineSpec>& lines) {
  auto made = backend::request_inputs(lines);
  if (!made) {
    refuse(inputs_[group], made.error());
    return false;
  }
  lines_.renew_inputs(group, wired_inputs(*std::move(made), lines));
  inputs_[group] = held(lines);
  return true;
}

/// Said once, not at each try.
void LineRequests::refuse(HeldRequest& held, const std::string& refusal) {
  if (held.refusal != refusal) log_.warn(refusal);
  held.refusal = refusal;
}

}  // namespace coupler::device
