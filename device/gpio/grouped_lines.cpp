// SPDX-License-Identifier: Apache-2.0
#include "device/gpio/grouped_lines.hpp"

#include <algorithm>
#include <cerrno>
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

std::size_t count_lines(const std::vector<WiredOutputs>& outputs) {
  std::size_t count = 0;
  for (const WiredOutputs& wired : outputs) count += wired.levels.size();
  return count;
}

void copy(Span<const int> from, Span<int> to) { std::copy(from.begin(), from.end(), to.begin()); }

}  // namespace

GroupedLines::GroupedLines(std::vector<WiredOutputs> outputs, std::vector<WiredInputs> inputs, Log& log)
    : levels_(count_lines(outputs)) {
  Span<int> free = levels_.all();
  for (WiredOutputs& wired : outputs) {
    Fault fault(wired.group->name(), log);
    const std::size_t count = wired.levels.size();
    copy(wired.levels, free.first(count));
    std::vector<int> next = wired.levels;
    outputs_.push_back({std::move(wired), free.first(count), std::move(next), std::move(fault)});
    free = free.from(count);
  }
  for (WiredInputs& wired : inputs) {
    Fault fault(wired.group->name(), log);
    LostEdges lost(wired.group->name(), log);
    inputs_.push_back({std::move(wired), std::move(fault), std::move(lost)});
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

void GroupedLines::take_edges(TimePoint now, EdgeSink& sink) {
  for (Input& input : inputs_) {
    EventSource* source = input.wired.counted;
    if (source == nullptr) continue;
    // What was taken counts, even if the chip is unplugged since: that is read()'s to say.
    (void)source->take_edges();
    for (std::size_t line = 0; line < input.wired.addresses.size(); ++line) {
      const Edges edges = source->edges(line, now);
      if (!edges.any()) continue;
      input.lost.note(edges.lost, now);
      sink.add(input.wired.addresses[line], edges);
    }
  }
}

/// To output.next. Returns 0 or an errno: EIO if a line does not have the level that it was driven to.
int GroupedLines::drive(Output& output, Span<int> scratch) {
  const int error = output.wired.group->drive(output.next);
  if (error != 0 || !output.wired.readback) return error;
  const auto got = scratch.first(output.next.size());
  if (const int unread = output.wired.group->read(got); unread != 0) return unread;
  return std::equal(got.begin(), got.end(), output.next.begin()) ? 0 : EIO;
}

bool GroupedLines::drive(Range range, Span<const std::uint16_t> levels) {
  for (Output& output : outputs_) {
    output.driven = false;
    copy(output.levels, output.next);
  }
  for (Output& output : outputs_) {
    const bool wanted = each_in(range, output.wired.addresses, [&](std::size_t line, std::size_t i) {
      output.next[line] = levels[i] != 0 ? 1 : 0;
    });
    if (!wanted) continue;
    if (!output.fault.note(drive(output, scratch_))) {
      // Its other lines have moved; what becomes of them was said with the fault.
      if (output.wired.readback) (void)output.wired.group->drive(output.levels);
      restore();
      return false;
    }
    output.driven = true;
  }
  for (Output& output : outputs_)
    if (output.driven) copy(output.next, output.levels);
  return true;
}

bool GroupedLines::driven(Range range, Span<std::uint16_t> levels) const {
  bool any = false;
  for (const Output& output : outputs_)
    any |= each_in(range, output.wired.addresses, [&](std::size_t line, std::size_t i) {
      levels[i] = static_cast<std::uint16_t>(output.levels[line]);
    });
  return any;
}

void GroupedLines::restore() {
  for (Output& output : outputs_) {
    if (!output.driven) continue;
    output.fault.note(output.wired.group->drive(output.levels));
  }
}

bool GroupedLines::drive_safe() {
  bool good = true;
  for (Output& output : outputs_) {
    copy(output.levels, output.next);
    for (std::size_t line = 0; line < output.next.size(); ++line)
      if (output.wired.safe[line] != Safe::hold)
        output.next[line] = output.wired.safe[line] == Safe::on ? 1 : 0;
    if (output.fault.note(drive(output, scratch_)))
      copy(output.next, output.levels);
    else
      good = false;
  }
  return good;
}

}  // namespace coupler::node
