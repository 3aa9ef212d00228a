// SPDX-License-Identifier: Apache-2.0
#include "coupler/device/gpio/watched_inputs.hpp"

#include <algorithm>
#include <array>
#include <utility>

namespace coupler::device {
namespace {

/// Enough for what the kernel keeps of a group, 1024 events at most.
constexpr std::size_t kept_changes = 1024;

std::vector<WatchedLine> watched(const std::vector<LineSpec>& lines, Span<const int> levels) {
  std::vector<WatchedLine> all;
  all.reserve(lines.size());
  for (std::size_t i = 0; i < lines.size(); ++i)
    all.emplace_back(i, lines[i].counted, lines[i].point->line.debounce, levels[i] != 0);
  return all;
}

std::array<int, max_group_size> levels_of(InputGroup& inputs, std::size_t count, TimePoint now) {
  std::array<int, max_group_size> levels{};
  (void)inputs.read(Span<int>(levels).first(count), now);  // if it fails, so does the next one, which is told
  return levels;
}

std::optional<TimePoint> earlier(std::optional<TimePoint> a, std::optional<TimePoint> b) {
  if (!a || !b) return a ? a : b;
  return std::min(*a, *b);
}

}  // namespace

WatchedInputs::WatchedInputs(const std::vector<LineSpec>& lines, Span<const int> levels)
    : changes_(kept_changes), lines_(Span<const WatchedLine>(watched(lines, levels))) {}

void WatchedInputs::settle(TimePoint now) {
  for (WatchedLine& line : lines_.all()) line.settle(now, changes_);
}

void WatchedInputs::put_levels(Span<int> levels, TimePoint now) {
  settle(now);
  for (std::size_t i = 0; i < levels.size(); ++i) levels[i] = lines_[i].level() ? 1 : 0;
}

void WatchedInputs::tell(TimePoint now, LineSink& sink) {
  settle(now);
  for (std::size_t i = 0; i < size(); ++i)
    if (const Edges edges = lines_[i].take_edges(); edges.any()) sink.edges(i, edges);
  while (const auto change = changes_.take()) {
    const bool level = change->level.level;
    if (lines_[change->line].tell(level))
      sink.changed(change->line, level, change->level.at);
    else
      changes_.lose(1);  // behind an odd number of lost ones: nobody can tell it from no change
  }
  if (const std::uint32_t lost = changes_.take_lost(); lost != 0) sink.lost(lost);
}

std::optional<TimePoint> WatchedInputs::next_change(TimePoint now) const {
  if (changes_.any()) return now;
  std::optional<TimePoint> next;
  for (const WatchedLine& line : lines_.all()) next = earlier(earlier(next, line.due()), line.doubt_due());
  return next;
}

bool WatchedInputs::has_doubts() const {
  const auto lines = lines_.all();
  return std::any_of(lines.begin(), lines.end(),
                     [](const WatchedLine& line) { return line.doubt_due().has_value(); });
}

void WatchedInputs::fail_all(int error, TimePoint now) {
  bool is_news = false;
  for (WatchedLine& line : lines_.all()) is_news |= line.fail(error, now);
  if (is_news) changes_.lose(1);
}

int WatchedInputs::error() const {
  const auto lines = lines_.all();
  const auto* failed =
      std::find_if(lines.begin(), lines.end(), [](const WatchedLine& line) { return line.error() != 0; });
  return failed == lines.end() ? 0 : failed->error();
}

SampledInputs::SampledInputs(std::unique_ptr<InputGroup> inputs, const std::vector<LineSpec>& lines,
                             TimePoint now)
    : WatchedInputs(lines, levels_of(*inputs, lines.size(), now)),
      inputs_(std::move(inputs)),
      next_(now),
      is_debounced_(std::any_of(lines.begin(), lines.end(),
                                [](const LineSpec& line) { return line.point->line.debounce.count() > 0; })) {
}

int SampledInputs::read(Span<int> levels, TimePoint now) {
  next_ = now + period;
  if (const int error = inputs_->read(levels, now); error != 0) {
    fail_all(error, now);
    return error;
  }
  for (std::size_t i = 0; i < levels.size(); ++i) look(i, levels[i] != 0, now);
  put_levels(levels, now);
  return 0;
}

void SampledInputs::tell(TimePoint now, LineSink& sink) {
  std::array<int, max_group_size> levels{};
  if (now >= next_) (void)read(Span<int>(levels).first(size()), now);  // if it fails, that is told
  WatchedInputs::tell(now, sink);
}

std::optional<TimePoint> SampledInputs::next_change(TimePoint now) const {
  return earlier(WatchedInputs::next_change(now), next_);
}

}  // namespace coupler::device
