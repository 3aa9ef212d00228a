// SPDX-License-Identifier: Apache-2.0
#include "device/gpio/grouped_lines.hpp"

#include <algorithm>
#include <utility>

namespace coupler::node {
namespace {

using modbus::Range;

/// Calls `use(line, i)` for each line of the group whose address is the range's i-th. Returns whether there
/// was one.
template <class Use>
bool each_in(Range range, const std::vector<std::uint16_t>& addresses, Use use) {
  auto at = std::lower_bound(addresses.begin(), addresses.end(), range.start());
  const auto first = at;
  for (; at != addresses.end() && range.contains(*at); ++at)
    use(static_cast<std::size_t>(at - addresses.begin()), static_cast<std::size_t>(*at - range.start()));
  return at != first;
}

}  // namespace

GroupedLines::GroupedLines(std::vector<WiredOutputs> outputs, std::vector<WiredInputs> inputs, Log& log) {
  for (WiredOutputs& wired : outputs) {
    Fault fault(wired.group->name(), log);
    std::vector<int> next = wired.levels;
    outputs_.push_back({std::move(wired), std::move(next), std::move(fault)});
  }
  for (WiredInputs& wired : inputs) {
    Fault fault(wired.group->name(), log);
    inputs_.push_back({std::move(wired), std::move(fault)});
  }
}

bool GroupedLines::read(Range range, Span<std::uint16_t> levels, TimePoint now) {
  bool good = true;
  for (Input& input : inputs_) {
    if (!each_in(range, input.wired.addresses, [](auto, auto) {})) continue;
    const auto got = Span<int>(scratch_).first(input.wired.addresses.size());
    if (input.fault.note(input.wired.group->read(got, now)))
      each_in(range, input.wired.addresses,
              [&](std::size_t line, std::size_t i) { levels[i] = got[line] != 0 ? 1 : 0; });
    else
      good = false;
  }
  return good;
}

bool GroupedLines::drive(Range range, Span<const std::uint16_t> levels) {
  for (Output& output : outputs_) output.driven = false;
  for (Output& output : outputs_) {
    const bool wanted = each_in(range, output.wired.addresses, [&](std::size_t line, std::size_t i) {
      output.next[line] = levels[i] != 0 ? 1 : 0;
    });
    if (!wanted) continue;
    if (!output.fault.note(output.wired.group->drive(output.next))) {
      output.next = output.wired.levels;
      restore();
      return false;
    }
    output.driven = true;
  }
  for (Output& output : outputs_)
    if (output.driven) output.wired.levels = output.next;
  return true;
}

bool GroupedLines::driven(Range range, Span<std::uint16_t> levels) const {
  bool any = false;
  for (const Output& output : outputs_)
    any |= each_in(range, output.wired.addresses, [&](std::size_t line, std::size_t i) {
      levels[i] = static_cast<std::uint16_t>(output.wired.levels[line]);
    });
  return any;
}

void GroupedLines::restore() {
  for (Output& output : outputs_) {
    if (!output.driven) continue;
    output.next = output.wired.levels;
    output.fault.note(output.wired.group->drive(output.next));
  }
}

bool GroupedLines::drive_safe() {
  bool good = true;
  for (Output& output : outputs_) {
    for (std::size_t line = 0; line < output.next.size(); ++line)
      if (output.wired.safe[line] != Safe::hold)
        output.next[line] = output.wired.safe[line] == Safe::on ? 1 : 0;
    if (output.fault.note(output.wired.group->drive(output.next)))
      output.wired.levels = output.next;
    else
      good = false;
  }
  return good;
}

}  // namespace coupler::node
