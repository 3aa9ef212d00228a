// SPDX-License-Identifier: Apache-2.0
#include "coupler/device/replay/recording.hpp"

#include <algorithm>
#include <map>
#include <optional>
#include <string_view>
#include <utility>
#include <variant>

#include <fmt/format.h>

#include "coupler/map/loader/load.hpp"
#include "coupler/map/same_value.hpp"
#include "coupler/record/reader.hpp"

namespace coupler::device {
namespace {

using Problem = tl::unexpected<std::string>;

using Indices = std::map<std::string_view, std::optional<std::uint32_t>, std::less<>>;  // nullopt: left out

Indices indices_of(const Map& recorded, const Map& played, std::vector<std::string>& left_out) {
  Indices indices;
  for (const Point& point : recorded.points) {
    const Point* const found = find(played, point.name);
    const std::string why = found == nullptr             ? "the map has no such point"
                            : !same_value(point, *found) ? "it has another type in the map"
                                                         : "";
    if (!why.empty()) left_out.push_back(fmt::format("'{}' is not played: {}", point.name, why));
    indices.emplace(point.name, why.empty()
                                    ? std::optional(static_cast<std::uint32_t>(found - played.points.begin()))
                                    : std::nullopt);
  }
  return indices;
}

std::optional<std::uint32_t> find_in(const Indices& indices, const std::string& name) {
  const auto found = indices.find(name);
  return found == indices.end() ? std::nullopt : found->second;
}

/// The recording's own map, and the one that plays it.
struct Maps {
  MapPtr recorded;
  MapPtr played;
};

tl::expected<Maps, std::string> maps_of(const record::Head& head, const std::string& file,
                                        const MapPtr& given) {
  LoadResult loaded = load_served_map(head.map, file);
  // One that a driver has given its name.
  if (!loaded.map) loaded = load_map_with_lock(head.map, file, {}, head.name);
  if (!loaded.map) {
    const auto first =
        std::find_if(loaded.diagnostics.begin(), loaded.diagnostics.end(),
                     [](const Diagnostic& each) { return each.severity == Diagnostic::Severity::error; });
    return Problem(fmt::format("{}: the map in it does not load: {}; {}", file, first->what, first->remedy));
  }
  return Maps{loaded.map, given ? given : loaded.map};
}

/// A recording begins without a connection, and makes it at once: that is no silence of the device.
void forget_first_connect(std::vector<Recording::Event>& events) {
  using Kind = Recording::Event::Kind;
  constexpr std::chrono::seconds at_once(1);
  if (events.empty() || events.front().kind != Kind::lost) return;
  const auto online =
      std::find_if(events.begin(), events.end(), [](const auto& each) { return each.kind == Kind::online; });
  if (online == events.end() || online->at > at_once) return;
  events.erase(
      std::remove_if(events.begin(), online, [](const auto& each) { return each.kind == Kind::lost; }),
      online);
}

/// Makes events of what lines say.
class EventMaker {
 public:
  using Event = Recording::Event;
  /// `dropped`: counts values of points that its map does not have, or of another size.
  EventMaker(const Map& map, const Indices& indices, std::vector<std::uint16_t>& registers,
             std::size_t& dropped)
      : map_(map), indices_(indices), registers_(registers), dropped_(dropped) {}

  /// But for its time; nullopt: it is of nothing that is played.
  std::optional<Event> operator()(const record::Value& value) const {
    const auto point = find_in(indices_, value.point);
    const bool is_known = indices_.find(value.point) != indices_.end();
    const bool fits = point && value.registers.size() == range(map_.points[*point]).count();
    if (!is_known || (point && !fits)) ++dropped_;
    if (!fits) return std::nullopt;
    const auto first = static_cast<std::uint32_t>(registers_.size());
    for (const std::uint16_t each : value.registers)
      registers_.push_back(holds_bits(map_.points[*point].table) && each != 0 ? std::uint16_t{1} : each);
    return Event{{}, Event::Kind::value, *point, first, {}};
  }
  std::optional<Event> operator()(const record::NoValue& none) const {
    const auto point = find_in(indices_, none.point);
    if (!point) return std::nullopt;
    return Event{{}, Event::Kind::exception, *point, 0, static_cast<modbus::Exception>(none.exception)};
  }
  std::optional<Event> operator()(const record::DeviceState& state) const {
    return Event{{}, state.online ? Event::Kind::online : Event::Kind::lost, 0, 0, {}};
  }
  std::optional<Event> operator()(const record::Remark&) const { return std::nullopt; }

 private:
  const Map& map_;
  const Indices& indices_;
  std::vector<std::uint16_t>& registers_;
  std::size_t& dropped_;
};

}  // namespace

tl::expected<Recording, std::string> Recording::read(std::istream& text, const std::string& file,
                                                     const MapPtr& given) {
  auto reader = record::Reader::open(text, file);
  if (!reader) return Problem(std::move(reader).error());
  const auto maps = maps_of(reader->head(), file, given);
  if (!maps) return Problem(maps.error());

  Recording recording;
  recording.map_ = maps->played;
  const Map& map = recording.map_->map();
  const Indices indices = indices_of(maps->recorded->map(), map, recording.left_out_);
  recording.periods_.resize(map.points.size());
  for (const auto& [name, seconds] : reader->head().periods)
    if (const auto point = find_in(indices, name))
      recording.periods_[*point] =
          std::chrono::duration_cast<Nanoseconds>(std::chrono::duration<double>(seconds));
  for (const auto& [name, why] : reader->head().not_recorded)
    recording.left_out_.push_back(fmt::format("'{}' is not in the recording: {}", name, why));
  recording.wall_ = reader->begin().wall;

  std::size_t dropped = 0;
  const EventMaker make(map, indices, recording.registers_, dropped);
  auto line = reader->next();
  for (; line && *line; line = reader->next()) {
    const Nanoseconds at = std::max((*line)->at.since_start - reader->begin().since_start, Nanoseconds(0));
    recording.length_ = std::max(recording.length_, at);
    if (const auto* state = std::get_if<record::DeviceState>(&(*line)->what))
      recording.is_foreign_ |= state->is_foreign;
    auto event = std::visit(make, (*line)->what);
    if (!event) continue;
    event->at = at;
    recording.events_.push_back(*event);
  }
  if (!line) return Problem(line.error());
  if (dropped > 0)
    recording.left_out_.push_back(fmt::format(
        "{} values are not played: of points that the recording's map does not have, or too short or long",
        dropped));
  forget_first_connect(recording.events_);
  // Changes that the device has told come late, with their own times.
  std::stable_sort(recording.events_.begin(), recording.events_.end(),
                   [](const Event& a, const Event& b) { return a.at < b.at; });
  return recording;
}

}  // namespace coupler::device
