// SPDX-License-Identifier: Apache-2.0
#include "coupler/device/gpio/grouped_lines.hpp"

#include <algorithm>
#include <cerrno>
#include <utility>

namespace coupler::device {
namespace {

using modbus::Range;

std::optional<std::uint16_t> address_of(const WiredOutputs::Line& line) { return line.address; }
std::optional<std::uint16_t> address_of(std::optional<std::uint16_t> input) { return input; }

/// Calls `use(line, i)` for each line of the group whose address is the range's i-th. Returns whether there
/// was one.
template <class Line, class Use>
bool each_in(Range range, const std::vector<Line>& lines, Use use) {
  bool any = false;
  for (std::size_t line = 0; line < lines.size(); ++line) {
    const auto address = address_of(lines[line]);
    if (!address || !range.contains(*address)) continue;
    use(line, static_cast<std::size_t>(*address - range.start()));
    any = true;
  }
  return any;
}

/// Its safe state asks for no level.
bool only_holds(const WiredOutputs& wired) {
  return std::all_of(wired.lines.begin(), wired.lines.end(),
                     [](const auto& line) { return line.safe == Safe::hold; });
}

void copy(Span<const int> from, Span<int> to) { std::copy(from.begin(), from.end(), to.begin()); }

}  // namespace

GroupedLines::GroupedLines(std::vector<WiredOutputs> outputs, std::vector<WiredInputs> inputs, Log& log)
    : log_(log) {
  for (WiredOutputs& wired : outputs) add(std::move(wired));
  for (WiredInputs& wired : inputs) add(std::move(wired));
}

void GroupedLines::add(WiredOutputs wired) { outputs_.push_back(output(std::move(wired))); }
void GroupedLines::add(WiredInputs wired) { inputs_.push_back(input(std::move(wired))); }

void GroupedLines::release() {
  outputs_.clear();
  inputs_.clear();
}

GroupedLines::Output GroupedLines::output(WiredOutputs wired) {
  std::vector<int> next;
  for (const WiredOutputs::Line& line : wired.lines) next.push_back(line.level);
  auto shared = std::make_unique<SharedArray<int>>(next.size() + 1);
  copy(next, shared->all().first(next.size()));
  Fault fault(wired.group->name(), (*shared)[next.size()], log_);
  return {std::move(wired), std::move(shared), std::move(next), std::move(fault)};
}

GroupedLines::Input GroupedLines::input(WiredInputs wired) {
  auto shared = std::make_unique<SharedArray<int>>(1);
  Fault fault(wired.group->name(), (*shared)[0], log_);
  LostEdges lost(wired.group->name(), log_);
  return {std::move(wired), std::move(shared), std::move(fault), std::move(lost)};
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
    if (!input.wired.counted) continue;
    // Edges that were taken count, even if the chip is unplugged since; read() reports that.
    (void)input.wired.group->take_edges();
    for (std::size_t line = 0; line < input.wired.addresses.size(); ++line) {
      const Edges edges = input.wired.group->edges(line, now);
      const auto address = input.wired.addresses[line];
      if (!edges.any() || !address) continue;
      input.lost.note(edges.lost, now);
      sink.add(*address, edges);
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
    copy(output.levels(), output.next);
  }
  for (Output& output : outputs_) {
    const bool wanted = each_in(range, output.wired.lines, [&](std::size_t line, std::size_t i) {
      output.next[line] = levels[i] != 0 ? 1 : 0;
    });
    if (!wanted) continue;
    if (!output.fault.note(drive(output, scratch_))) {
      // Its other lines have moved; if they cannot be driven back, that fault is already logged.
      if (output.wired.readback) (void)output.wired.group->drive(output.levels());
      restore();
      return false;
    }
    output.driven = true;
  }
  for (Output& output : outputs_)
    if (output.driven) copy(output.next, output.levels());
  return true;
}

bool GroupedLines::driven(Range range, Span<std::uint16_t> levels) const {
  bool any = false;
  for (const Output& output : outputs_)
    any |= each_in(range, output.wired.lines, [&](std::size_t line, std::size_t i) {
      levels[i] = static_cast<std::uint16_t>(output.levels()[line]);
    });
  return any;
}

void GroupedLines::restore() {
  for (Output& output : outputs_) {
    if (!output.driven) continue;
    output.fault.note(output.wired.group->drive(output.levels()));
  }
}

bool GroupedLines::drive_safe() {
  bool good = true;
  for (Output& output : outputs_) {
    for (std::size_t line = 0; line < output.next.size(); ++line)
      output.next[line] = safe_level(output.wired.lines[line].safe, output.levels()[line]);
    const bool is_driven = output.fault.note(drive(output, scratch_));
    const bool is_gone = !is_driven && !output.wired.group->is_plugged();
    // A chip that is unplugged has to come back in its safe state.
    if (is_driven || is_gone) copy(output.next, output.levels());
    good &= is_driven || (is_gone && only_holds(output.wired));
  }
  return good;
}

std::vector<InputGroup*> GroupedLines::event_sources() const {
  std::vector<InputGroup*> all;
  for (const Input& input : inputs_)
    if (input.wired.group->descriptor() >= 0) all.push_back(input.wired.group.get());
  return all;
}

void GroupedLines::lose_outputs(std::size_t group) {
  Output& lost = outputs_[group];
  lost.fault.note(ENODEV);
  lost.wired.group = std::make_shared<AbsentOutputs>(lost.wired.group->name());
  lost.wired.request.lost = true;
}

void GroupedLines::lose_inputs(std::size_t group) {
  Input& lost = inputs_[group];
  lost.fault.note(ENODEV);
  lost.wired.group = std::make_shared<AbsentInputs>(lost.wired.group->name());
  lost.wired.request.lost = true;
}

void GroupedLines::renew_outputs(std::size_t group, WiredOutputs again) {
  Output renewed = output(std::move(again));
  (*renewed.shared)[renewed.next.size()] = ENODEV;
  renewed.fault.note(0);
  outputs_[group] = std::move(renewed);
}

void GroupedLines::renew_inputs(std::size_t group, WiredInputs again) {
  Input renewed = input(std::move(again));
  (*renewed.shared)[0] = ENODEV;
  renewed.fault.note(0);
  inputs_[group] = std::move(renewed);
}

/// Lines of `old` that have no coil in `successor` (null: there is none) go to their safe state.
void GroupedLines::abandon(Output& old, const Output* successor) {
  bool any = false;
  for (std::size_t line = 0; line < old.next.size(); ++line) {
    const bool goes_on = successor != nullptr && successor->wired.lines[line].address;
    old.next[line] = old.levels()[line];
    if (goes_on || !old.wired.lines[line].address) continue;
    old.next[line] = safe_level(old.wired.lines[line].safe, old.next[line]);
    any = true;
  }
  if (any && old.fault.note(old.wired.group->drive(old.next))) copy(old.next, old.levels());
}

void GroupedLines::take_over(GroupedLines& before) {
  for (Output& old : before.outputs_) {
    const auto successor = std::find_if(outputs_.begin(), outputs_.end(),
                                        [&](const Output& o) { return o.wired.group == old.wired.group; });
    abandon(old, successor == outputs_.end() ? nullptr : &*successor);
    if (successor == outputs_.end()) continue;
    copy(old.shared->all(), successor->shared->all());
  }
  for (const Input& old : before.inputs_)
    for (Input& input : inputs_)
      if (input.wired.group == old.wired.group) copy(old.shared->all(), input.shared->all());
}

}  // namespace coupler::device
