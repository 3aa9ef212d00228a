// SPDX-License-Identifier: Apache-2.0
// From the lines that are held to those that another map wants.
#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include "coupler/device/gpio/backend.hpp"
#include "coupler/device/gpio/line_requests.hpp"

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

/// The level that an output begins with: the map's initial one, or its safe one if `safe`.
int first_level(const Point& point, bool safe) {
  const int initial = !point.initial.empty() && point.initial[0] != 0 ? 1 : 0;
  return safe ? safe_level(point.safe, initial) : initial;
}

void add_line(std::string& errors, const std::string& text) { errors += (errors.empty() ? "" : "\n") + text; }

/// Counters, latched points or debouncing need the edges of the input.
bool needs_edges(const LineSpec& wanted) {
  return wanted.counted.has_value() || wanted.point->line.debounce.count() > 0;
}

/// Chooses the inputs that are watched for changes: those whose edges the map needs, and of the others as
/// many as can be.
void choose_watched(LineSpecs& wanted) {
  std::size_t left = backend::max_watched();
  for (LineSpec& line : wanted) {
    if (is_output(line) || needs_edges(line)) continue;
    line.watched = left > 0;
    if (left > 0) --left;
  }
}

/// The lines of the map; `errors` names those that do not exist.
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
               fmt::format("point '{}': {} is already the line of point '{}'; give one of them another line",
                           point.name, to_string(*found), other->second->name));
  }
  choose_watched(wanted);
  return wanted;
}

/// Groups them into as few requests as the kernel allows.
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

/// A request of the wiring before that is kept.
struct KeptRequest {
  std::size_t group = 0;                ///< of the outputs, or of the inputs
  std::vector<const LineSpec*> wanted;  ///< for each of its lines; null: the map does not want it
};

/// The difference of two wirings: what to do with held lines when other lines are wanted. It views the wanted
/// lines.
class RequestPlan {
 public:
  /// `before` may be null.
  RequestPlan(GroupedLines* before, const LineSpecs& wanted) : wanted_(wanted) {
    if (before != nullptr) {
      for (std::size_t i = 0; i < before->output_groups(); ++i) keep_outputs(i, before->outputs(i).request);
      for (std::size_t i = 0; i < before->input_groups(); ++i) keep_inputs(i, before->inputs(i).request);
    }
    for (const LineSpec& line : wanted)
      if (kept_.count(&line) == 0) (held_.count(&line) != 0 ? later : fresh).push_back(line);
  }

  std::vector<KeptRequest> outputs;
  std::vector<KeptRequest> inputs;
  LineSpecs fresh;     ///< nobody holds them: they can be requested while the others are in use
  LineSpecs later;     ///< held in requests that end: they can be requested after that
  std::string errors;  ///< outputs whose settings cannot change, since lines beside them stay; one a line

 private:
  /// The lines of the request that are wanted with other settings than it has.
  LineSpecs note(const HeldRequest& request, KeptRequest& kept) {
    LineSpecs changed;
    for (const LineSpec& line : wanted_)
      for (std::size_t i = 0; i < request.lines.size(); ++i) {
        if (!is_same_line(held_as(line), request.lines[i])) continue;
        held_.insert(&line);
        if (is_same_request(held_as(line), request.lines[i]))
          kept.wanted[i] = &line;
        else
          changed.push_back(line);
      }
    return changed;
  }

  void keep(std::vector<KeptRequest>& requests, KeptRequest kept) {
    kept_.insert(kept.wanted.begin(), kept.wanted.end());
    requests.push_back(std::move(kept));
  }

  static bool is_wanted(const KeptRequest& kept) {
    return std::any_of(kept.wanted.begin(), kept.wanted.end(),
                       [](const auto* line) { return line != nullptr; });
  }

  void keep_outputs(std::size_t group, const HeldRequest& request) {
    if (request.lost) return;
    KeptRequest kept{group, std::vector<const LineSpec*>(request.lines.size())};
    const LineSpecs changed = note(request, kept);
    if (!is_wanted(kept)) return;
    for (const LineSpec& line : changed)
      add_line(errors,
               fmt::format("point '{}': {} is held by one request together with outputs that stay, so its "
                           "direction and its keys (active_low, bias, drive) cannot change while the node "
                           "runs; restart the node",
                           line.point->name, to_string(line.line)));
    keep(outputs, std::move(kept));
  }

  /// To request inputs again moves nothing, so a request is only kept if none of its lines changes.
  void keep_inputs(std::size_t group, const HeldRequest& request) {
    if (request.lost) return;
    KeptRequest kept{group, std::vector<const LineSpec*>(request.lines.size())};
    if (note(request, kept).empty() && is_wanted(kept)) keep(inputs, std::move(kept));
  }

  const LineSpecs& wanted_;
  std::set<const LineSpec*> kept_;
  std::set<const LineSpec*> held_;
};

/// Finds and requests lines, and collects the errors so that one run reports all of them.
class PreparedLines : public PreparedWiring {
 public:
  PreparedLines(const Map& map, LineRequests* before, bool safe, Log& log)
      : map_(map),
        before_(before),
        log_(log),
        inventory_(backend::chips()),
        wanted_(find_lines(map, inventory_, safe, errors_)),
        plan_(before == nullptr ? nullptr : &before->groups(), wanted_),
        next_(std::make_unique<LineRequests>(log)) {}

  /// Requests what nobody holds, unless there are errors already. Returns all errors.
  const std::string& request() {
    if (!plan_.errors.empty()) add_line(errors_, plan_.errors);
    if (!errors_.empty()) return errors_;
    for (const KeptRequest& kept : plan_.outputs) keep_outputs(kept);
    for (const KeptRequest& kept : plan_.inputs) keep_inputs(kept);
    for (const LineSpecs& lines : grouped(plan_.fresh))
      if (const auto made = next_->request(lines, map_.service.readback); !made)
        add_line(errors_, made.error());
    return errors_;
  }

  std::unique_ptr<Wiring> take_over() override {
    if (before_ == nullptr) return std::move(next_);
    const LineSpecs reused = reused_outputs();
    next_->groups().take_over(before_->groups());
    for (const LineSpec& wanted : reused) {
      const auto level = static_cast<std::uint16_t>(wanted.level);
      (void)next_->groups().drive(range(*wanted.point), Span<const std::uint16_t>(&level, 1));
    }
    before_->groups().release();
    for (const std::string& line : idle_)
      log_.write(line +
                 " is not in the map any more, but stays held until the node ends (an output in its safe "
                 "state): it was requested together with lines that stay");
    for (const LineSpecs& lines : grouped(plan_.later)) {
      const auto made = next_->request(lines, map_.service.readback);
      if (made) continue;
      log_.warn(made.error());
      next_->add_missing(lines, map_.service.readback);
    }
    return std::move(next_);
  }

 private:
  void rewire(HeldLine& line, const LineSpec* wanted) {
    if (wanted == nullptr && line.point != nullptr)
      idle_.push_back(fmt::format("{} line {}", line.chip, line.offset));
    line.point = wanted == nullptr ? nullptr : wanted->point;
  }

  void keep_outputs(const KeptRequest& kept) {
    WiredOutputs wired = before_->groups().outputs(kept.group);
    wired.readback = map_.service.readback;
    for (std::size_t i = 0; i < kept.wanted.size(); ++i) {
      rewire(wired.request.lines[i], kept.wanted[i]);
      wired.lines[i].address.reset();
      if (kept.wanted[i] == nullptr) continue;
      wired.lines[i].address = kept.wanted[i]->point->address;
      wired.lines[i].safe = kept.wanted[i]->point->safe;
    }
    next_->groups().add(std::move(wired));
  }

  void keep_inputs(const KeptRequest& kept) {
    WiredInputs wired = before_->groups().inputs(kept.group);
    for (std::size_t i = 0; i < kept.wanted.size(); ++i) {
      rewire(wired.request.lines[i], kept.wanted[i]);
      wired.addresses[i].reset();
      if (kept.wanted[i] != nullptr) wired.addresses[i] = kept.wanted[i]->point->address;
    }
    next_->groups().add(std::move(wired));
  }

  /// Outputs that are held, but had no point in the map before.
  LineSpecs reused_outputs() const {
    LineSpecs all;
    for (const KeptRequest& kept : plan_.outputs) {
      const HeldRequest& held = before_->groups().outputs(kept.group).request;
      for (std::size_t i = 0; i < kept.wanted.size(); ++i)
        if (kept.wanted[i] != nullptr && held.lines[i].point == nullptr) all.push_back(*kept.wanted[i]);
    }
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
  std::vector<std::string> idle_;  ///< lines that stay held for no point
};

}  // namespace

Wiring::Prepared LineRequests::prepare(const Map& map, LineRequests* before, bool safe, Log& log) {
  auto next = std::make_unique<PreparedLines>(map, before, safe, log);
  if (const std::string& errors = next->request(); !errors.empty()) return tl::unexpected(errors);
  return next;
}

}  // namespace coupler::device
