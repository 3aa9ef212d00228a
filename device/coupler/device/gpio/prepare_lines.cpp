// SPDX-License-Identifier: Apache-2.0
#include "coupler/device/gpio/prepare_lines.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <utility>

#include "coupler/device/gpio/backend.hpp"
#include "coupler/device/gpio/request_plan.hpp"

namespace coupler::device {
namespace {

using LineSpecs = std::vector<LineSpec>;

/// The edges of the input that counters and latched points want.
std::optional<Edge> counted(const Map& map, const Point& input) {
  std::optional<Edge> all;
  for (const Point& point : map.points)
    for (const EdgeOf* wanted : {&point.counter, &point.latched})
      if (wanted->input == input.name) all = !all || *all == wanted->edge ? wanted->edge : Edge::both;
  return all;
}

void add_line(std::string& errors, const std::string& text) { errors += (errors.empty() ? "" : "\n") + text; }

/// The lines of the map; `errors` says which there are not.
LineSpecs find_lines(const Map& map, const Inventory& inventory, bool safe, std::string& errors) {
  LineSpecs wanted;
  std::map<std::pair<const Chip*, unsigned>, const Point*> users;
  for (const Point& point : map.points) {
    if (!point.line.present()) continue;
    const auto found = inventory.find(point.line);
    if (!found) {
      add_line(errors, fmt::format("point '{}': {}", point.name, found.error()));
      continue;
    }
    const auto [other, is_new] = users.emplace(std::pair(found->chip, found->offset), &point);
    if (is_new)
      wanted.push_back({&point, *found, counted(map, point), first_level(point, safe)});
    else
      add_line(errors,
               fmt::format("point '{}': {} is the line of point '{}' too; give one of them another line",
                           point.name, to_string(*found), other->second->name));
  }
  return wanted;
}

/// As few requests as the kernel needs for them.
std::vector<LineSpecs> grouped(const LineSpecs& wanted) {
  std::vector<LineSpecs> groups;
  for (const LineSpec& line : wanted) {
    const auto group = std::find_if(groups.begin(), groups.end(), [&](const LineSpecs& lines) {
      return lines.size() < max_group_size && backend::fits(lines, line);
    });
    if (group != groups.end())
      group->push_back(line);
    else
      groups.push_back({line});
  }
  return groups;
}

std::string name_of(const HeldLine& line) { return fmt::format("{} line {}", line.chip, line.offset); }

/// Finds and requests, and collects what went wrong so that one run tells everything.
class NextLines : public NextWiring {
 public:
  NextLines(const Map& map, LineRequests* before, bool safe, Log& log)
      : map_(map),
        before_(before),
        log_(log),
        inventory_(backend::chips()),
        wanted_(find_lines(map, inventory_, safe, errors_)),
        plan_(plan_requests(before, wanted_)),
        next_(std::make_unique<LineRequests>(log)) {
    if (!plan_.errors.empty()) add_line(errors_, plan_.errors);
    if (!errors_.empty()) return;
    for (const KeptRequest& kept : plan_.outputs) keep_outputs(kept);
    for (const KeptRequest& kept : plan_.inputs) keep_inputs(kept);
    for (const LineSpecs& lines : grouped(plan_.fresh))
      if (const auto made = next_->request(lines, map.service.readback); !made)
        add_line(errors_, made.error());
  }

  const std::string& errors() const { return errors_; }

  std::unique_ptr<Wiring> take_over() override {
    if (before_ == nullptr) return std::move(next_);
    const std::vector<const LineSpec*> taken_up = wanted_of_idle_outputs();
    next_->groups().take_over(before_->groups());
    for (const LineSpec* wanted : taken_up) {
      const auto level = static_cast<std::uint16_t>(wanted->level);
      (void)next_->groups().drive(range(*wanted->point), Span<const std::uint16_t>(&level, 1));
    }
    before_->release();
    for (const std::string& line : idle_)
      log_.write(
          line +
          " is not in the map any more, but stays held until the node ends (an output in its safe state): "
          "it was requested together with lines that stay");
    for (const LineSpecs& lines : grouped(plan_.later)) {
      const auto made = next_->request(lines, map_.service.readback);
      if (made) continue;
      log_.warn(made.error());
      next_->add_missing(lines, map_.service.readback);
    }
    return std::move(next_);
  }

 private:
  HeldRequest held_from(const HeldRequest& old, const KeptRequest& kept) {
    HeldRequest held{old.lines, {}};
    for (std::size_t i = 0; i < kept.wanted.size(); ++i) {
      held.points.push_back(kept.wanted[i] == nullptr ? nullptr : kept.wanted[i]->point);
      if (kept.wanted[i] == nullptr && old.points[i] != nullptr) idle_.push_back(name_of(old.lines[i]));
    }
    return held;
  }

  void keep_outputs(const KeptRequest& kept) {
    WiredOutputs wired = before_->groups().outputs(kept.group);
    wired.readback = map_.service.readback;
    for (std::size_t i = 0; i < kept.wanted.size(); ++i) {
      wired.addresses[i].reset();
      if (kept.wanted[i] == nullptr) continue;
      wired.addresses[i] = kept.wanted[i]->point->address;
      wired.safe[i] = kept.wanted[i]->point->safe;
    }
    next_->keep_outputs(std::move(wired), held_from(before_->outputs()[kept.group], kept));
  }

  void keep_inputs(const KeptRequest& kept) {
    WiredInputs wired = before_->groups().inputs(kept.group);
    for (std::size_t i = 0; i < kept.wanted.size(); ++i) {
      wired.addresses[i].reset();
      if (kept.wanted[i] != nullptr) wired.addresses[i] = kept.wanted[i]->point->address;
    }
    next_->keep_inputs(std::move(wired), held_from(before_->inputs()[kept.group], kept));
  }

  /// Outputs that are held, but were no point's.
  std::vector<const LineSpec*> wanted_of_idle_outputs() const {
    std::vector<const LineSpec*> all;
    for (const KeptRequest& kept : plan_.outputs)
      for (std::size_t i = 0; i < kept.wanted.size(); ++i)
        if (kept.wanted[i] != nullptr && before_->outputs()[kept.group].points[i] == nullptr)
          all.push_back(kept.wanted[i]);
    return all;
  }

  const Map& map_;
  LineRequests* before_;
  Log& log_;
  std::string errors_;
  Inventory inventory_;
  LineSpecs wanted_;
  RequestPlan plan_;
  std::unique_ptr<LineRequests> next_;
  std::vector<std::string> idle_;  ///< held on, for no point
};

}  // namespace

tl::expected<std::unique_ptr<NextWiring>, std::string> prepare_lines(const Map& map, LineRequests* before,
                                                                     bool safe, Log& log) {
  auto next = std::make_unique<NextLines>(map, before, safe, log);
  if (!next->errors().empty()) return tl::unexpected(next->errors());
  return next;
}

}  // namespace coupler::device
