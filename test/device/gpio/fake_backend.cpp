// SPDX-License-Identifier: Apache-2.0
#include "test/device/gpio/fake_backend.hpp"

#include <algorithm>
#include <cerrno>
#include <memory>

#include "coupler/device/gpio/backend.hpp"

namespace coupler::device {
namespace {

class FakeLines {
 public:
  explicit FakeLines(const std::vector<LineSpec>& lines) : name_(names_of(lines)) {
    for (const LineSpec& line : lines) lines_.emplace_back(line.line.chip->name, line.line.offset);
    machine.held.insert(lines_.begin(), lines_.end());
  }
  FakeLines(const FakeLines&) = delete;
  FakeLines& operator=(const FakeLines&) = delete;
  ~FakeLines() {
    for (const auto& line : lines_) {
      machine.held.erase(line);
      machine.history.push_back("release " + std::to_string(line.second));
    }
  }
  const std::string& name() const { return name_; }
  bool is_plugged() const { return machine.gone.count(lines_.front().first) == 0; }
  unsigned offset(std::size_t i) const { return lines_[i].second; }

 private:
  std::string name_;
  std::vector<std::pair<std::string, unsigned>> lines_;
};

class FakeOutputs : public OutputGroup {
 public:
  explicit FakeOutputs(const std::vector<LineSpec>& lines) : lines_(lines) {
    for (const LineSpec& line : lines) put("take", line.line.offset, line.level);
  }
  const std::string& name() const override { return lines_.name(); }
  bool is_plugged() override { return lines_.is_plugged(); }
  int drive(Span<const int> levels) override {
    if (!lines_.is_plugged()) return ENODEV;
    for (std::size_t i = 0; i < levels.size(); ++i)
      if (machine.levels[lines_.offset(i)] != levels[i]) put("drive", lines_.offset(i), levels[i]);
    return 0;
  }
  int read(Span<int>) override { return 0; }

 private:
  static void put(const std::string& what, unsigned offset, int level) {
    machine.levels[offset] = level;
    machine.history.push_back(what + " " + std::to_string(offset) + " " + std::to_string(level));
  }
  FakeLines lines_;
};

class FakeInputs : public InputGroup {
 public:
  explicit FakeInputs(const std::vector<LineSpec>& lines) : lines_(lines) {
    const std::string how = lines.front().watched ? "take " : "take to look at ";
    for (const LineSpec& line : lines) machine.history.push_back(how + std::to_string(line.line.offset));
  }
  const std::string& name() const override { return lines_.name(); }
  bool is_plugged() override { return lines_.is_plugged(); }
  int read(Span<int> levels, TimePoint) override {
    std::fill(levels.begin(), levels.end(), 1);
    return 0;
  }

 private:
  FakeLines lines_;
};

bool is_free(const std::vector<LineSpec>& lines) {
  return std::none_of(lines.begin(), lines.end(), [](const LineSpec& line) {
    return machine.refused.count(line.line.offset) != 0 ||
           machine.held.count({line.line.chip->name, line.line.offset}) != 0;
  });
}

}  // namespace

namespace backend {

Inventory chips() { return Inventory(machine.chips); }

std::size_t max_watched() { return machine.watched; }

bool fits(const std::vector<LineSpec>& group, const LineSpec& line) {
  return group.front().watched == line.watched && is_output(group.front()) == is_output(line) &&
         group.front().point->line.active_low == line.point->line.active_low;
}

tl::expected<std::unique_ptr<OutputGroup>, std::string> request_outputs(const std::vector<LineSpec>& lines) {
  if (!is_free(lines)) return tl::unexpected("busy: " + names_of(lines));
  return std::make_unique<FakeOutputs>(lines);
}

tl::expected<std::unique_ptr<InputGroup>, std::string> request_inputs(const std::vector<LineSpec>& lines) {
  if (!is_free(lines)) return tl::unexpected("busy: " + names_of(lines));
  for (const LineSpec& line : lines)
    if (line.watched && machine.silent.count(line.line.offset) != 0)
      return tl::unexpected("no edges: " + names_of({line}));
  return std::make_unique<FakeInputs>(lines);
}

}  // namespace backend

}  // namespace coupler::device
