// SPDX-License-Identifier: Apache-2.0
#include "device/gpio/wire.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <utility>

#include "device/gpio/backend.hpp"
#include "device/gpio/grouped_lines.hpp"

namespace coupler::node {
namespace {

/// The edges of the input that counters and latched points want.
std::optional<Edge> counted(const Map& map, const Point& input) {
  std::optional<Edge> all;
  for (const Point& point : map.points)
    for (const EdgeOf* wanted : {&point.counter, &point.latched})
      if (wanted->input == input.name) all = !all || *all == wanted->edge ? wanted->edge : Edge::both;
  return all;
}

/// Finds and requests, and collects what went wrong so that one run tells everything.
class Wirer {
 public:
  explicit Wirer(const Map& map) : map_(map), inventory_(backend::read_chip) {
    for (const Point& point : map.points)
      if (point.line.present()) find(point);
    if (!errors_.empty()) return;
    for (const auto& group : groups_) is_output(group.front()) ? add_outputs(group) : add_inputs(group);
  }

  tl::expected<Wiring, std::string> finish(Log& log) {
    if (!errors_.empty()) return tl::unexpected(std::move(errors_));
    return Wiring{std::make_unique<GroupedLines>(std::move(outputs_), std::move(inputs_), log),
                  std::move(events_)};
  }

 private:
  void error(const std::string& text) { errors_ += (errors_.empty() ? "" : "\n") + text; }

  void find(const Point& point) {
    const auto found = inventory_.find(point.line);
    if (!found) return error(fmt::format("point '{}': {}", point.name, found.error()));
    const auto [other, is_new] = users_.emplace(std::pair(found->chip, found->offset), &point);
    if (!is_new)
      return error(fmt::format("point '{}': {} is the line of point '{}' too; give one of them another line",
                               point.name, to_string(*found), other->second->name));
    const Wanted wanted{&point, *found, counted(map_, point)};
    const auto group = std::find_if(groups_.begin(), groups_.end(), [&](const auto& lines) {
      return lines.size() < max_group_size && backend::fits(lines, wanted);
    });
    if (group != groups_.end())
      group->push_back(wanted);
    else
      groups_.push_back({wanted});
  }

  void add_inputs(const std::vector<Wanted>& lines) {
    auto made = backend::request_inputs(lines);
    if (!made) return error(made.error());
    WiredInputs inputs;
    for (const Wanted& line : lines) inputs.addresses.push_back(line.point->address);
    if (made->events != nullptr) events_.push_back(made->events);
    if (std::any_of(lines.begin(), lines.end(), [](const Wanted& line) { return line.counted.has_value(); }))
      inputs.counted = made->events;
    inputs.group = std::move(made->group);
    inputs_.push_back(std::move(inputs));
  }

  void add_outputs(const std::vector<Wanted>& lines) {
    auto made = backend::request_outputs(lines);
    if (!made) return error(made.error());
    WiredOutputs outputs;
    for (const Wanted& line : lines) {
      outputs.addresses.push_back(line.point->address);
      outputs.safe.push_back(line.point->safe);
      outputs.levels.push_back(initial_level(*line.point));
    }
    outputs.group = *std::move(made);
    outputs.readback = map_.service.readback;
    outputs_.push_back(std::move(outputs));
  }

  const Map& map_;
  Inventory inventory_;
  std::map<std::pair<const Chip*, unsigned>, const Point*> users_;
  std::vector<std::vector<Wanted>> groups_;  ///< what the kernel is asked for, a request each
  std::vector<WiredOutputs> outputs_;
  std::vector<WiredInputs> inputs_;
  std::vector<EventSource*> events_;
  std::string errors_;
};

}  // namespace

tl::expected<Wiring, std::string> wire(const Map& map, Log& log) { return Wirer(map).finish(log); }

}  // namespace coupler::node
