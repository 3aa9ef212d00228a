// SPDX-License-Identifier: Apache-2.0
// `axes:`, outputs as joints of a trajectory.
#include <cstdint>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <type_traits>
#include <unordered_map>
#include <vector>

#include <fmt/format.h>

#include "coupler/codec/number.hpp"
#include "coupler/map/joint.hpp"
#include "coupler/map/loader/joints.hpp"
#include "coupler/map/loader/map_reader.hpp"
#include "coupler/map/loader/point_names.hpp"
#include "coupler/map/loader/point_reader.hpp"
#include "coupler/map/loader/scalar.hpp"
#include "coupler/map/plain_value.hpp"

namespace coupler::loader {
namespace {

using codec::Type;

constexpr std::string_view an_axis_point = "a coil or a holding register";

bool can_be_axis(const Point& point) {
  return is_writable(point) && point.count == 1 && point.format.type != Type::STRING;
}

/// Its position is the published value, whatever that is.
bool is_measured(const Point& point) { return point.scale.present() || codec::is_float(point.format.type); }

/// The key of `positions`, as the value of another key would be written: 0 and 1 of a BOOL are off and on.
Entry value_of_key(const Entry& position, Type type) {
  Entry value;
  value.kind = Entry::Kind::scalar;
  value.at = position.key_at;
  value.text = position.key;
  if (type == Type::BOOL && (value.text == "0" || value.text == "1"))
    value.text = value.text == "0" ? "off" : "on";
  return value;
}

/// Returns the integer in these registers, or whether the bit is on; nullopt if it is too large.
std::optional<std::int64_t> integer_in(const Point& point, const std::uint16_t* registers) {
  if (point.format.type == Type::BOOL) return PlainValue<bool>::decode(registers, point) ? 1 : 0;
  return codec::with_number(point.format.type, [&](auto zero) -> std::optional<std::int64_t> {
    using Number = decltype(zero);
    const auto number = codec::take<Number>(point.format, registers);
    if (std::is_same_v<Number, std::uint64_t> &&
        number > static_cast<Number>(std::numeric_limits<std::int64_t>::max()))
      return std::nullopt;
    return static_cast<std::int64_t>(number);
  });
}

/// `positions` of one axis.
class PositionsReader {
 public:
  PositionsReader(const Reader& axis, const Point& point, const Context& context)
      : axis_(axis), point_(point), context_(context) {}

  /// Empty if something is wrong.
  std::vector<AxisPosition> read(const Entry& positions) {
    if (positions.kind != Entry::Kind::map) {
      axis_.wrong("positions", "a map");
      return {};
    }
    bool good = true;
    for (const Entry& each : positions.children) good = read_one(each) && good;
    if (good && by_position_.size() < 2)
      good = error(positions.at,
                   fmt::format("'positions' has {}, and an axis needs two",
                               by_position_.empty() ? "no value" : "one value"),
                   as_in_example());
    if (!good) return {};
    std::vector<AxisPosition> ascending;
    ascending.reserve(by_position_.size());
    for (const auto& [position, given] : by_position_) ascending.push_back({given.value, position});
    return ascending;
  }

 private:
  struct Given {
    std::int64_t value;
    std::string_view key;
  };

  bool error(Position at, std::string what, std::string remedy) const {
    context_.problems.error(at, std::move(what), std::move(remedy));
    return false;
  }

  std::string as_in_example() const {
    return fmt::format("write it as in 'positions: {}'", axis_.example("positions"));
  }

  bool read_one(const Entry& entry) {
    const bool is_bare = entry.kind == Entry::Kind::scalar && !entry.quoted;
    const auto position = is_bare ? parse_number(entry.text) : std::nullopt;
    if (!position)
      return error(entry.at,
                   fmt::format("the position of {} must be a number, not {}", shown(entry.key), shown(entry)),
                   as_in_example());
    const auto registers =
        registers_of("positions", value_of_key(entry, point_.format.type), point_, context_);
    if (registers.empty()) return false;
    const auto value = integer_in(point_, registers.data());
    if (!value)
      return error(entry.key_at, fmt::format("'positions' has {}, which is too large", shown(entry.key)),
                   fmt::format("write a value up to {}", std::numeric_limits<std::int64_t>::max()));
    const auto [same_value, is_new_value] = by_value_.emplace(*value, entry.key);
    if (!is_new_value)
      return error(entry.key_at,
                   same_value->second == entry.key
                       ? fmt::format("'positions' has {} twice", shown(entry.key))
                       : fmt::format("{} and {} are the same value of 'positions'", shown(same_value->second),
                                     shown(entry.key)),
                   "keep one of the two");
    const auto [same_place, is_new_place] = by_position_.emplace(*position, Given{*value, entry.key});
    if (!is_new_place)
      return error(entry.at,
                   fmt::format("{} and {} both have the position {}", shown(same_place->second.key),
                               shown(entry.key), *position),
                   "give each value a position of its own");
    return true;
  }

  const Reader& axis_;
  const Point& point_;
  const Context& context_;
  std::unordered_map<std::int64_t, std::string_view> by_value_;
  std::map<double, Given> by_position_;
};

/// Collects the axes of a map.
class AxesReader {
 public:
  AxesReader(const DraftPoints& points, const Map& head, const std::vector<Tool>& tools, Joints& joints,
             const Context& context)
      : names_(points), head_(head), tools_(tools), joints_(joints), context_(context) {}

  void read(const Entry& entry) {
    if (!joints_.check_name(axis_kind, entry)) return;
    if (!check_map(entry, fmt::format("the axis '{}' holds its point", entry.key),
                   fmt::format("write it as in '{}: {{point: valve}}'", entry.key), context_))
      return;
    const Reader reader(entry, Section::axis, context_);
    Axis axis;
    axis.name = context_.map.keep(entry.key);
    reader.text("point", axis.point);
    reader.text("joint", axis.joint);
    joints_.check_joint(axis_kind, reader, entry, joint_name(head_, axis));
    if (reader.lacks("point"))
      context_.problems.error(entry.key_at, fmt::format("'{}' has no 'point'", entry.key),
                              fmt::format("add one, with the name of {}", an_axis_point));
    const Eligible eligible{can_be_axis, an_axis_point,
                            [this](const DraftPoint& draft) { return why_no_axis(draft.point); }};
    if (const Entry* point = names_.check(reader, "point", eligible, context_)) {
      check_single_use(*point, axis);
      axis.positions = read_positions(reader, names_.get(point->text)->point);
    }
    axes_.push_back(axis);
  }

  const std::vector<Axis>& axes() const { return axes_; }

 private:
  /// The point of an axis that stands before.
  struct Taken {
    std::string_view axis;
    Position at;
  };

  std::optional<Hindrance> why_no_axis(const Point& point) const {
    const std::string other = fmt::format("write the name of {}", an_axis_point);
    if (!is_writable(point.table))
      return Hindrance{fmt::format("is in {}, and an axis is written", to_string(point.table)), other};
    if (!is_writable(point))
      return Hindrance{"has 'access: read', and an axis is written",
                       "remove 'access', or write the name of another point"};
    if (point.count > 1)
      return Hindrance{fmt::format("has {} values, and an axis has one", point.count), other};
    if (point.format.type == Type::STRING)
      return Hindrance{"has the type STRING, and an axis is a BOOL or a number", other};
    if (is_pulsed(point)) return Hindrance{"has a 'pulse', so it would go back by itself", "remove 'pulse'"};
    if (point.latched.present())
      return Hindrance{"is 'latched': an edge of an input switches it on", "write the name of another point"};
    for (const Tool& tool : tools_)
      if (tool.close == point.name || tool.open == point.name)
        return Hindrance{fmt::format("is an output of the tool '{}', which nothing else moves", tool.name),
                         "write the name of another point"};
    return std::nullopt;
  }

  void check_single_use(const Entry& point, const Axis& axis) {
    const auto [first, is_new] = taken_.emplace(point.text, Taken{axis.name, point.at});
    if (!is_new)
      context_.problems.error(point.at,
                              fmt::format("{} is already the point of the axis '{}', in line {}",
                                          shown(point.text), first->second.axis, first->second.at.line),
                              "give each axis a point of its own", {{first->second.at, "it is here"}});
    else if (!is_readable(names_.get(point.text)->point))
      context_.problems.warning(
          point.at,
          fmt::format("{} has 'access: write', so the topic '{}' does not have the joint of '{}'",
                      shown(point.text), joint_states_topic, axis.name),
          "remove 'access' if the device lets it be read");
  }

  Span<const AxisPosition> read_positions(const Reader& reader, const Point& point) const {
    const Entry* given = reader.find("positions");
    if (given == nullptr && point.format.type == Type::BOOL)
      return context_.map.keep(std::vector<AxisPosition>{{0, 0}, {1, 1}});
    if (given == nullptr) return {};
    if (!is_measured(point)) return context_.map.keep(PositionsReader(reader, point, context_).read(*given));
    reader.refuse(
        "positions",
        fmt::format("'positions' does not apply to {}: its position is the published value",
                    point.scale.present() ? "a point with a 'scale'" : to_string(point.format.type)),
        "leave 'positions' out");
    return {};
  }

  PointNames names_;
  const Map& head_;
  const std::vector<Tool>& tools_;
  Joints& joints_;
  const Context& context_;
  std::vector<Axis> axes_;
  std::unordered_map<std::string_view, Taken> taken_;  ///< points by name
};

}  // namespace

std::vector<Axis> read_axes(const Reader& top, const DraftPoints& points, const Map& head,
                            const std::vector<Tool>& tools, Joints& joints, const Context& context) {
  AxesReader reader(points, head, tools, joints, context);
  for (const Entry& axis : joints.entries(axis_kind, top)) reader.read(axis);
  return reader.axes();
}

}  // namespace coupler::loader
