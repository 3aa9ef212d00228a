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

void GroupedLines::add(WiredOutputs wired) {
  Shared levels = levels_of(wired);
  outputs_.push_back(output(std::move(wired), std::move(levels)));
}
void GroupedLines::add(WiredInputs wired) { inputs_.push_back(input(std::move(wired))); }

void GroupedLines::release() {
  outputs_.clear();
  inputs_.clear();
}

GroupedLines::Shared GroupedLines::levels_of(const WiredOutputs& wired) {
  auto shared = std::make_unique<SharedArray<int>>(wired.lines.size() + 1);
  for (std::size_t line = 0; line < wired.lines.size(); ++line) (*shared)[line] = wired.lines[line].level;
  return shared;
}

GroupedLines::Output GroupedLines::output(WiredOutputs wired, Shared shared) {
  std::vector<int> next(wired.lines.size());
  Fault fault(wired.group->name(), (*shared)[next.size()], log_);
  return {std::move(wired), std::move(shared), std::move(next), std::move(fault)};
}

GroupedLines::Input GroupedLines::input(WiredInputs wired) {
  auto shared = std::make_unique<SharedArray<int>>(1);
  auto before = std::make_unique<SharedArray<Before>>(wired.addresses.size());
  Fault fault(wired.group->name(), (*shared)[0], log_);
  LostEdges lost(wired.group->name(), log_);
  return {std::move(wired), std::move(shared), std::move(before), std::move(fault), std::move(lost)};
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

/// Tells of lines as their inputs.
class GroupedLines::Teller : public LineSink {
 public:
  Teller(Input& input, TimePoint now, EdgeSink& sink) : input_(input), now_(now), sink_(sink) {}

  void edges(std::size_t line, const Edges& edges) override {
    const auto address = input_.wired.addresses[line];
    if (!address) return;
    input_.lost.note(edges.lost, now_);
    sink_.add(*address, edges);
  }
  void changed(std::size_t line, bool level, TimePoint at) override {
    if (const auto address = input_.wired.addresses[line]) sink_.changed(*address, level, at);
  }
  void lost(std::uint32_t changes) override { sink_.lost(changes); }

  /// The lines of a chip that is plugged in again: what is another level now than before.
  void changed_meanwhile() {
    for (std::size_t line = 0; line < input_.before->all().size(); ++line) {
      if ((*input_.before)[line] == Before::unknown) continue;
      const Before before = std::exchange((*input_.before)[line], Before::unknown);
      const auto level = input_.wired.group->level(line);
      if (level && *level != (before == Before::on)) changed(line, *level, now_);
    }
  }

 private:
  Input& input_;
  TimePoint now_;
  EdgeSink& sink_;
};

void GroupedLines::take_edges(TimePoint now, EdgeSink& sink) {
  for (Input& input : inputs_) {
    Teller teller(input, now, sink);
    if (!input.wired.request.lost) teller.changed_meanwhile();
    // Edges that were taken count, even if the chip is unplugged since; read() reports that.
    input.wired.group->take_edges();
    input.wired.group->tell(now, teller);
  }
}

std::optional<TimePoint> GroupedLines::next_change(TimePoint now) const {
  std::optional<TimePoint> next;
  for (const Input& input : inputs_)
    if (const auto its = input.wired.group->next_change(now); its && (!next || *its < *next)) next = its;
  return next;
}

bool GroupedLines::has_to_look() const {
  return std::any_of(inputs_.begin(), inputs_.end(),
                     [](const Input& input) { return input.wired.group->has_to_look(); });
}

/// To output.next. Returns 0 or an errno.
int GroupedLines::drive(Output& output, Span<int> scratch) {
  const int error = output.wired.group->drive(output.next);
  return error != 0 ? error : verify(output, scratch);
}

/// Returns 0 or an errno: EIO if a line does not have the level of output.next, to which it was driven.
int GroupedLines::verify(Output& output, Span<int> scratch) {
  if (!output.wired.readback) return 0;
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

/// To output.next, whatever becomes of other groups. What the chip has been told holds for its other lines
/// although one does not follow; a chip that is unplugged has to come back so.
GroupedLines::Driven GroupedLines::drive_alone(Output& output) {
  const int refused = output.wired.group->drive(output.next);
  const bool is_driven = output.fault.note(refused != 0 ? refused : verify(output, scratch_));
  const bool is_gone = !is_driven && !output.wired.group->is_plugged();
  if (refused == 0 || is_gone) copy(output.next, output.levels());
  return is_driven ? Driven::yes : is_gone ? Driven::unplugged : Driven::no;
}

bool GroupedLines::drive_each(Range range, Span<const std::uint16_t> levels) {
  bool good = true;
  for (Output& output : outputs_) {
    copy(output.levels(), output.next);
    const bool wanted = each_in(range, output.wired.lines, [&](std::size_t line, std::size_t i) {
      output.next[line] = levels[i] != 0 ? 1 : 0;
    });
    if (wanted) good &= drive_alone(output) != Driven::no;
  }
  return good;
}

bool GroupedLines::are_plugged(Range range) const {
  return std::all_of(outputs_.begin(), outputs_.end(), [&](const Output& output) {
    const bool is_gone = output.wired.request.lost || output.fault.error() == ENODEV;
    return !is_gone || !each_in(range, output.wired.lines, [](auto, auto) {});
  });
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
  for (std::size_t group = 0; group < outputs_.size(); ++group) good &= drive_safe(group);
  return good;
}

bool GroupedLines::drive_safe(std::size_t group) {
  Output& output = outputs_[group];
  for (std::size_t line = 0; line < output.next.size(); ++line)
    output.next[line] = safe_level(output.wired.lines[line].safe, output.levels()[line]);
  const Driven driven = drive_alone(output);
  return driven == Driven::yes || (driven == Driven::unplugged && only_holds(output.wired));
}

void GroupedLines::give_up_outputs(std::size_t group) {
  WiredOutputs& hung = outputs_[group].wired;
  hung.group = std::make_shared<HungOutputs>(hung.group->name());
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
  for (std::size_t line = 0; line < lost.before->all().size(); ++line)
    if (const auto level = lost.wired.group->level(line))
      (*lost.before)[line] = *level ? Before::on : Before::off;
  lost.wired.group = std::make_shared<AbsentInputs>(lost.wired.group->name());
  lost.wired.request.lost = true;
}

void GroupedLines::renew_outputs(std::size_t group, WiredOutputs again) {
  Output& old = outputs_[group];
  // A process that drives still, to no chip, may change the levels yet: those that it knows stay.
  const bool same = again.lines.size() == old.wired.lines.size();
  Shared levels = same ? std::move(old.shared) : levels_of(again);
  Output renewed = output(std::move(again), std::move(levels));
  (*renewed.shared)[renewed.next.size()] = ENODEV;
  renewed.fault.note(0);
  renewed.is_renewed = true;
  old = std::move(renewed);
}

void GroupedLines::settle() {
  for (Output& output : outputs_) {
    if (!std::exchange(output.is_renewed, false)) continue;
    copy(output.levels(), output.next);
    (void)drive_alone(output);  // what fails is logged
  }
}

void GroupedLines::renew_inputs(std::size_t group, WiredInputs again) {
  Input renewed = input(std::move(again));
  const Input& old = inputs_[group];
  for (std::size_t line = 0; line < renewed.wired.addresses.size(); ++line)
    for (std::size_t i = 0; i < old.wired.addresses.size(); ++i)
      if (renewed.wired.addresses[line] == old.wired.addresses[i]) (*renewed.before)[line] = (*old.before)[i];
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
