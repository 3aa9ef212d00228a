// SPDX-License-Identifier: Apache-2.0
// `tools:`, what the driver opens and closes.
#include <algorithm>
#include <optional>
#include <unordered_map>

#include <fmt/format.h>

#include "coupler/map/joint.hpp"
#include "coupler/map/loader/joints.hpp"
#include "coupler/map/loader/map_reader.hpp"
#include "coupler/map/loader/point_names.hpp"

namespace coupler::loader {
namespace {

constexpr std::string_view output_keys[] = {"close", "open"};
constexpr std::string_view sensor_keys[] = {"closed", "opened", "holds"};

constexpr std::string_view an_output = "a coil, or of a BOOL in a holding register";
constexpr std::string_view a_sensor = "a discrete input, or of another single bit";

bool can_drive(const Point& point) { return is_single_bit(point) && is_writable(point); }
bool can_sense(const Point& point) { return is_single_bit(point) && is_readable(point); }

bool is_on(Span<const std::uint16_t> bit) {
  return std::any_of(bit.begin(), bit.end(), [](std::uint16_t word) { return word != 0; });
}
bool is_safe_on(const Point& point) {
  return point.safe == Safe::on && (point.safe_value.empty() || is_on(point.safe_value));
}
/// It keeps its value where others go to their safe values.
bool is_held(const Point& point) {
  return point.safe == Safe::hold || (!holds_bits(point.table) && point.safe_value.empty());
}

std::optional<Hindrance> no_single_bit(const Point& point, std::string_view key, std::string_view expected) {
  if (is_single_bit(point)) return std::nullopt;
  return Hindrance{fmt::format("{}, and '{}' is a single bit",
                               point.count > 1 ? fmt::format("has {} values", point.count)
                                               : fmt::format("has the type {}", to_string(point.format.type)),
                               key),
                   fmt::format("write the name of {}", expected)};
}

std::optional<Hindrance> no_sensor(const DraftPoint& draft, std::string_view key) {
  if (auto wrong = no_single_bit(draft.point, key, a_sensor)) return wrong;
  if (is_readable(draft.point)) return std::nullopt;
  return Hindrance{"has 'access: write', so nobody can see it",
                   "remove 'access', or write the name of another point"};
}

/// Checks that the two ends have different positions: otherwise a goal could not tell them apart.
void check_positions(const Reader& reader, const Tool& tool, const Context& context) {
  const Entry* given = reader.find("positions");
  if (given == nullptr || tool.positions.open != tool.positions.closed) return;
  std::string what = fmt::format("'open' and 'closed' are both {}", tool.positions.open);
  if (given->children.size() == 1) {
    const std::string& key = given->children[0].key;
    what = fmt::format("'{}' is {}, as '{}' is if not given", key, tool.positions.open,
                       key == "open" ? "closed" : "open");
  }
  context.problems.error(
      given->at, std::move(what),
      fmt::format("write two positions, as in 'positions: {}'", reader.example("positions")));
}

/// Collects the tools of a map.
class ToolsReader {
 public:
  ToolsReader(const DraftPoints& points, const Map& head, Joints& joints, const Context& context)
      : names_(points), head_(head), joints_(joints), context_(context) {}

  void read(const Entry& entry) {
    if (!joints_.check_name(tool_kind, entry)) return;
    if (!check_map(entry, fmt::format("the tool '{}' holds its points and times", entry.key),
                   fmt::format("write it as in '{}: {{close: valve, travel: 300ms}}'", entry.key), context_))
      return;
    const Reader reader(entry, Section::tool, context_);
    Tool tool;
    tool.name = context_.map.keep(std::string(entry.key));
    const std::size_t errors = context_.problems.errors();
    reader.fields(tool);
    const bool has_its_values = context_.problems.errors() == errors;
    check_outputs(reader, entry, tool);
    check_sensors(reader, entry);
    joints_.check_joint(tool_kind, reader, entry, joint_name(head_, tool));
    if (has_its_values) {
      check_times(reader, tool);
      check_positions(reader, tool, context_);
    }
    tools_.push_back(tool);
  }

  const std::vector<Tool>& tools() const { return tools_; }

 private:
  /// An output of a tool that stands before.
  struct Taken {
    std::string_view tool;
    Position at;
  };

  void error(Position at, std::string what, std::string remedy) const {
    context_.problems.error(at, std::move(what), std::move(remedy));
  }

  void check_outputs(const Reader& reader, const Entry& entry, const Tool& tool) {
    if (reader.lacks("close") && reader.lacks("open"))
      error(entry.key_at, fmt::format("'{}' has no 'close' and no 'open'", entry.key),
            fmt::format("add one of them, with the name of {}", an_output));
    for (const std::string_view key : output_keys) {
      const auto why_not = [&](const DraftPoint& draft) {
        return no_output(draft, key, reader, tool.direct);
      };
      const Entry* output = names_.check(reader, key, {can_drive, an_output, why_not}, context_);
      if (output == nullptr) continue;
      const auto [first, is_new] = taken_.emplace(output->text, Taken{tool.name, output->at});
      if (!is_new && first->second.tool != tool.name)
        context_.problems.error(output->at,
                                fmt::format("{} is already an output of the tool '{}', in line {}",
                                            shown(output->text), first->second.tool, first->second.at.line),
                                "give each tool outputs of its own", {{first->second.at, "it is here"}});
    }
    check_never_both(reader);
    // Off is the other end then.
    if (!tool.hold && reader.lacks("close") != reader.lacks("open"))
      error(reader.find("hold")->key_at, "'hold: false' is for a tool with 'close' and 'open'",
            fmt::format("remove it: the tool leaves its end when '{}' goes off",
                        reader.has("close") ? "close" : "open"));
  }

  /// Outside of its movements, too, no tool has both outputs on.
  void check_never_both(const Reader& reader) const {
    const Entry* close = reader.find("close");
    const Entry* open = reader.find("open");
    if (close == nullptr || open == nullptr || close->text == open->text) return;
    const DraftPoint* closing = names_.get(close->text);
    const DraftPoint* opening = names_.get(open->text);
    if (closing == nullptr || opening == nullptr) return;
    const auto both = [&](std::string_view when, std::string_view key) {
      error(open->at, fmt::format("{} and {} {}", shown(close->text), shown(open->text), when),
            fmt::format("write '{}: off' at one of them", key));
    };
    const auto goes_on_beside = [](const Point& a, const Point& b) {
      return is_safe_on(a) && (is_safe_on(b) || is_held(b));
    };
    if (goes_on_beside(closing->point, opening->point) || goes_on_beside(opening->point, closing->point))
      both("may both be on in their safe state", "safe");
    if (is_on(closing->point.initial) && is_on(opening->point.initial))
      both("are both on when a node starts", "initial");
  }

  static std::optional<Hindrance> no_output(const DraftPoint& draft, std::string_view key, const Reader& tool,
                                            bool direct) {
    const Point& point = draft.point;
    if (auto wrong = no_single_bit(point, key, an_output)) return wrong;
    if (!is_writable(point.table))
      return Hindrance{fmt::format("is in {}, and '{}' is written", to_string(point.table), key),
                       fmt::format("write the name of {}", an_output)};
    if (!is_writable(point))
      return Hindrance{fmt::format("has 'access: read', and '{}' is written", key),
                       "remove 'access', or write the name of another point"};
    if (is_pulsed(point))
      return Hindrance{"has a 'pulse', so it would go off before the end is reached",
                       tool.has("close") && tool.has("open")
                           ? "remove 'pulse'; with 'hold: false' the tool switches it off at the end"
                           : "remove 'pulse'"};
    if (point.latched.present())
      return Hindrance{"is 'latched': an edge of an input switches it on", "write the name of another point"};
    if (point.host.deadman.present() && !direct)
      return Hindrance{"has a 'deadman', which would move the tool",
                       fmt::format("remove it{}, or write 'direct: true' below the tool",
                                   draft.options.has("deadman") ? "" : " from 'defaults'")};
    return std::nullopt;
  }

  void check_sensors(const Reader& reader, const Entry& entry) const {
    for (const std::string_view key : sensor_keys)
      names_.check(reader, key,
                   {can_sense, a_sensor, [&](const DraftPoint& draft) { return no_sensor(draft, key); }},
                   context_);
    check_different(reader, entry.key);
    if (reader.has("empty") && reader.lacks("holds"))
      error(reader.find("empty")->key_at, "'empty' needs 'holds', which says whether there is a part",
            "add that, or remove 'empty'");
    const bool no_closed = reader.lacks("closed");
    const bool no_opened = reader.lacks("opened");
    if (!reader.lacks("travel") || (!no_closed && !no_opened)) return;
    if (no_closed && no_opened)
      error(entry.key_at, fmt::format("'{}' has neither 'closed' nor 'opened', and no 'travel'", entry.key),
            "add 'travel', how long it takes to an end, as in 'travel: 300ms'");
    else
      error(
          entry.key_at,
          fmt::format("'{}' has no '{}' sensor and no 'travel'", entry.key, no_closed ? "closed" : "opened"),
          "give one, as in 'travel: 300ms'");
  }

  /// No point is two parts of one tool.
  void check_different(const Reader& reader, std::string_view tool) const {
    std::unordered_map<std::string_view, std::string_view> key_of;
    for (const std::string_view key : {"close", "open", "closed", "opened", "holds"}) {
      const Entry* value = reader.find(key);
      if (value == nullptr || value->kind != Entry::Kind::scalar) continue;
      const auto [first, is_new] = key_of.emplace(value->text, key);
      if (is_new) continue;
      error(value->at,
            fmt::format("{} is both '{}' and '{}' of '{}'", shown(value->text), first->second, key, tool),
            key == "open" ? "remove 'open': without it the tool opens when 'close' is off"
                          : fmt::format("write the name of another point, or remove '{}'", key));
    }
  }

  void check_times(const Reader& reader, const Tool& tool) const {
    const Entry* travel = reader.find("travel");
    const Entry* timeout = reader.find("timeout");
    const Entry* settle = reader.find("settle");
    if (travel != nullptr && tool.travel > tool.timeout && timeout != nullptr)
      error(travel->at, "'travel' is longer than 'timeout', after which the tool is stuck",
            "make 'timeout' at least as long");
    else if (travel != nullptr && tool.travel > tool.timeout)
      error(travel->at,
            fmt::format("'travel' is longer than 'timeout', which is {} if not given",
                        find_key("timeout", Section::tool)->fallback),
            "add a 'timeout' that is at least as long as 'travel'");
    if (settle != nullptr && tool.settle >= tool.timeout)
      error(settle->at, "'settle' is not shorter than 'timeout', so no sensor would count in time",
            "make 'settle' shorter, or 'timeout' longer");
  }

  PointNames names_;
  const Map& head_;
  Joints& joints_;
  const Context& context_;
  std::vector<Tool> tools_;
  std::unordered_map<std::string_view, Taken> taken_;  ///< outputs by name
};

}  // namespace

std::vector<Tool> read_tools(const Reader& top, const DraftPoints& points, const Map& head, Joints& joints,
                             const Context& context) {
  ToolsReader reader(points, head, joints, context);
  for (const Entry& tool : joints.entries(tool_kind, top)) reader.read(tool);
  return reader.tools();
}

}  // namespace coupler::loader
