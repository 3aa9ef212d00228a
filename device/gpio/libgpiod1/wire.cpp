// SPDX-License-Identifier: Apache-2.0
#include "device/gpio/libgpiod1/wire.hpp"

#include <fmt/format.h>

#include <map>
#include <tuple>
#include <utility>

#include "device/gpio/grouped_lines.hpp"
#include "device/gpio/libgpiod1/event_line.hpp"
#include "device/gpio/libgpiod1/request.hpp"
#include "device/gpio/libgpiod1/value_groups.hpp"

namespace coupler::node::libgpiod1 {
namespace {

/// Finds and requests, and collects what went wrong so that one run tells everything.
class Wirer {
 public:
  explicit Wirer(const Map& map) {
    const Chips chips;
    for (const Point& point : map.points)
      if (point.line.present()) find(chips, point);
    if (errors_.empty()) request_all();
  }

  tl::expected<Wiring, std::string> finish(Log& log) {
    if (!errors_.empty()) return tl::unexpected(std::move(errors_));
    return Wiring{std::make_unique<GroupedLines>(std::move(outputs_), std::move(inputs_), log),
                  std::move(events_)};
  }

 private:
  /// Chip, use, flags: what the lines of one request share.
  using Key = std::tuple<std::string, Use, int>;

  void error(const std::string& text) { errors_ += (errors_.empty() ? "" : "\n") + text; }

  void find(const Chips& chips, const Point& point) {
    auto found = chips.find(point.line);
    if (!found) return error(fmt::format("point '{}': {}", point.name, found.error()));
    const auto [other, is_new] = users_.emplace(found->line, &point);
    if (!is_new)
      return error(fmt::format("point '{}': {} is the line of point '{}' too; give one of them another line",
                               point.name, to_string(*found), other->second->name));
    if (point.table == Table::discrete_inputs && point.line.debounce.count() > 0) {
      debounced_.push_back({&point, *std::move(found)});
      return;
    }
    const Use use = point.table == Table::coils ? Use::output : Use::input;
    const Key key(gpiod_chip_name(found->chip.get()), use, flags_of(point.line));
    auto& groups = groups_[key];
    if (groups.empty() || groups.back().size() == max_group_size) groups.emplace_back();
    groups.back().push_back({&point, *std::move(found)});
  }

  void request_all() {
    for (const auto& [key, groups] : groups_)
      for (const auto& lines : groups) request(lines, std::get<Use>(key));
    for (const Wanted& line : debounced_) request({line}, Use::edges);
  }

  void request(const std::vector<Wanted>& lines, Use use) {
    auto made = Request::make(lines, use);
    if (!made) return error(made.error());
    if (use == Use::output) return add_outputs(lines, *std::move(made));
    WiredInputs inputs;
    for (const Wanted& line : lines) inputs.addresses.push_back(line.point->address);
    if (use == Use::edges) {
      auto event_line = std::make_unique<EventLine>(*std::move(made), lines.front().point->line.debounce);
      events_.push_back(event_line.get());
      inputs.group = std::move(event_line);
    } else {
      inputs.group = std::make_unique<Inputs>(*std::move(made));
    }
    inputs_.push_back(std::move(inputs));
  }

  void add_outputs(const std::vector<Wanted>& lines, std::unique_ptr<Request> request) {
    WiredOutputs outputs;
    for (const Wanted& line : lines) {
      outputs.addresses.push_back(line.point->address);
      outputs.safe.push_back(line.point->safe);
      outputs.levels.push_back(initial_level(*line.point));
    }
    outputs.group = std::make_unique<Outputs>(std::move(request));
    outputs_.push_back(std::move(outputs));
  }

  std::map<gpiod_line*, const Point*> users_;
  std::map<Key, std::vector<std::vector<Wanted>>> groups_;
  std::vector<Wanted> debounced_;
  std::vector<WiredOutputs> outputs_;
  std::vector<WiredInputs> inputs_;
  std::vector<EventSource*> events_;
  std::string errors_;
};

}  // namespace

tl::expected<Wiring, std::string> wire(const Map& map, Log& log) { return Wirer(map).finish(log); }

}  // namespace coupler::node::libgpiod1
