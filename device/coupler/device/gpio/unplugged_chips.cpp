// SPDX-License-Identifier: Apache-2.0
// Lines whose chip is unplugged, and comes back.
#include <cstdint>
#include <optional>
#include <utility>

#include "coupler/device/gpio/backend.hpp"
#include "coupler/device/gpio/line_requests.hpp"

namespace coupler::device {
namespace {

/// The lines that points of the map want of a request that was lost, where they are now. nullopt: not all of
/// them are there.
std::optional<std::vector<LineSpec>> find_again(const HeldRequest& held, const Inventory& inventory) {
  std::vector<LineSpec> found;
  for (const HeldLine& line : held.lines) {
    if (line.point == nullptr) continue;
    const auto again = inventory.find(line.point->line);
    if (!again) return std::nullopt;
    const LineSpec wanted{line.point, *again, line.counted, 0, line.watched && !held.sampled};
    if (!found.empty() && !backend::fits(found, wanted)) return std::nullopt;
    found.push_back(wanted);
  }
  if (found.empty()) return std::nullopt;
  return found;
}

}  // namespace

bool LineRequests::reconnect(bool safe) {
  const bool lost = lose();
  return renew(safe) || lost;
}

bool LineRequests::lose() {
  bool any = false;
  for (std::size_t i = 0; i < lines_.output_groups(); ++i) {
    if (lines_.outputs(i).request.lost || lines_.outputs(i).group->is_plugged()) continue;
    lines_.lose_outputs(i);
    any = true;
  }
  for (std::size_t i = 0; i < lines_.input_groups(); ++i) {
    if (lines_.inputs(i).request.lost || lines_.inputs(i).group->is_plugged()) continue;
    lines_.lose_inputs(i);
    any = true;
  }
  return any;
}

bool LineRequests::renew(bool safe) {
  std::optional<Inventory> inventory;  // it takes time to read, and is seldom needed
  const auto find = [&](const HeldRequest& held) {
    if (!held.lost) return std::optional<std::vector<LineSpec>>();
    if (!inventory) inventory = backend::chips();
    return find_again(held, *inventory);
  };
  bool any = false;
  for (std::size_t i = 0; i < lines_.output_groups(); ++i)
    if (const auto lines = find(lines_.outputs(i).request)) any |= renew_outputs(i, *lines, safe);
  for (std::size_t i = 0; i < lines_.input_groups(); ++i)
    if (const auto lines = find(lines_.inputs(i).request)) any |= renew_inputs(i, *lines);
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
    fail(lines_.outputs(group).request, made.error());
    return false;
  }
  lines_.renew_outputs(group, wired_outputs(*std::move(made), wanted, lines_.outputs(group).readback));
  return true;
}

bool LineRequests::renew_inputs(std::size_t group, const std::vector<LineSpec>& lines) {
  auto made = backend::request_inputs(lines);
  if (!made) {
    fail(lines_.inputs(group).request, made.error());
    return false;
  }
  const bool sampled = !lines.front().watched;
  lines_.renew_inputs(
      group, sampled ? sampled_inputs(*std::move(made), lines) : wired_inputs(*std::move(made), lines));
  return true;
}

/// Logged once, not at each try.
void LineRequests::fail(HeldRequest& held, const std::string& error) {
  if (held.error != error) log_.warn(error);
  held.error = error;
}

}  // namespace coupler::device
