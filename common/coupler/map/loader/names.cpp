// SPDX-License-Identifier: Apache-2.0
#include "coupler/map/loader/names.hpp"

#include <algorithm>
#include <iterator>
#include <unordered_map>

#include <fmt/format.h>

#include "coupler/map/joint.hpp"
#include "coupler/map/loader/scalar.hpp"

namespace coupler::loader {
namespace {

constexpr std::string_view rule =
    "begin with a letter and use letters, digits and '_', with '/' between parts";

using FirstOfName = std::unordered_map<std::string_view, const DraftPoint*>;

/// The point whose name stands before the suffix.
const DraftPoint* before(std::string_view suffix, std::string_view name, const FirstOfName& first) {
  if (name.size() <= suffix.size() || name.substr(name.size() - suffix.size()) != suffix) return nullptr;
  const auto found = first.find(name.substr(0, name.size() - suffix.size()));
  return found != first.end() ? found->second : nullptr;
}

/// `name/write` is where the driver listens for values of `name`.
const DraftPoint* written_by(std::string_view name, const FirstOfName& first) {
  const DraftPoint* point = before("/write", name, first);
  return point != nullptr && is_writable(point->point) ? point : nullptr;
}

/// `name/stamped` is where the driver publishes `name` with the time of its value.
const DraftPoint* stamped_by(std::string_view name, const FirstOfName& first) {
  const DraftPoint* point = before("/stamped", name, first);
  return point != nullptr && point->point.host.stamped ? point : nullptr;
}

/// `name` is what the driver would serve.
void warn_of_taken_place(Position at, std::string_view name, std::string_view what, std::string remedy,
                         const Context& context) {
  context.problems.warning(at, fmt::format("{} is also {}, and the point takes its place", shown(name), what),
                           std::move(remedy));
}

/// Topics that came after maps had such points, which keep them.
void warn_of_missing_topic(std::string_view name, const FirstOfName& first, Position at,
                           const Context& context) {
  const DraftPoint* sampled = before("/sample", name, first);
  const bool is_sample = sampled != nullptr && sampled->point.host.stamped;
  if (name != points_topic && !is_sample) return;
  warn_of_taken_place(at, name,
                      fmt::format("a topic of the driver, with {}",
                                  is_sample ? "the samples of a point" : "what the map says of each point"),
                      "give the point another name if programs need that topic", context);
}

/// ROS 2 takes no part of a name that begins with a digit, as in "a/1b"; ROS 1 does.
bool is_ros2_name(std::string_view name) {
  for (std::size_t slash = name.find('/'); slash != std::string_view::npos; slash = name.find('/', slash + 1))
    if (slash + 1 < name.size() && is_digit(name[slash + 1])) return false;
  return true;
}

void warn_of_ros1_name(std::string_view name, Position at, const Context& context) {
  if (!is_ros2_name(name))
    context.problems.warning(at, fmt::format("{} is a valid name only in ROS 1", shown(name)),
                             "for ROS 2 begin each part after a '/' with a letter");
}

void check_topic(const DraftPoint& draft, const FirstOfName& first, const Context& context) {
  const std::string_view name = draft.point.name;
  if (!is_relative_ros_name(name)) {
    context.problems.error(draft.name_at, fmt::format("{} is not a valid ROS name", shown(name)),
                           std::string(rule));
  } else if (is_driver_topic(name)) {
    context.problems.error(draft.name_at, fmt::format("'{}' is a topic of the driver itself", name),
                           "give the point another name");
  } else if (const DraftPoint* other = written_by(name, first)) {
    context.problems.error(draft.name_at,
                           fmt::format("{} is the topic that writes {} (line {})", shown(name),
                                       shown(other->point.name), other->name_at.line),
                           "give the point another name", {{other->name_at, "it is here"}});
  } else if (const DraftPoint* stamped = stamped_by(name, first)) {
    context.problems.error(draft.name_at,
                           fmt::format("{} is the topic of the stamps of {} (line {})", shown(name),
                                       shown(stamped->point.name), stamped->name_at.line),
                           "give the point another name", {{stamped->name_at, "it is here"}});
  } else {
    warn_of_ros1_name(name, draft.name_at, context);
    warn_of_missing_topic(name, first, draft.name_at, context);
  }
}

}  // namespace

bool is_driver_topic(std::string_view name) {
  return std::find(std::begin(driver_topics), std::end(driver_topics), name) != std::end(driver_topics);
}

bool is_relative_ros_name(std::string_view name) {
  if (name.empty() || !is_letter(name.front()) || name.back() == '/') return false;
  const bool characters = std::all_of(
      name.begin(), name.end(), [](char c) { return is_letter(c) || is_digit(c) || c == '_' || c == '/'; });
  return characters && name.find("//") == std::string_view::npos;
}

void check_map_name(std::string_view name, Position at, const Context& context) {
  if (!is_relative_ros_name(name))
    context.problems.error(at, fmt::format("{} is not a valid ROS name", shown(name)), std::string(rule));
  else
    warn_of_ros1_name(name, at, context);
}

void check_point_names(const DraftPoints& points, bool has_wait_for, const Context& context) {
  FirstOfName first;
  for (const DraftPoint& draft : points) {
    const auto [found, is_new] = first.emplace(draft.point.name, &draft);
    if (!is_new)
      context.problems.error(draft.name_at,
                             fmt::format("{} is already the name of a point, in line {}",
                                         shown(draft.point.name), found->second->name_at.line),
                             "give every point of the map a name of its own",
                             {{found->second->name_at, "the other is here"}});
  }
  for (const DraftPoint& draft : points) {
    check_topic(draft, first, context);
    const std::string_view name = draft.point.name;
    if (has_wait_for && takes_place_of(name, wait_for_action))
      warn_of_taken_place(draft.name_at, wait_for_action, "the action that waits for values",
                          "give the point another name, or leave the key 'wait_for' out", context);
  }
}

void warn_of_tool_names(const DraftPoints& points, const std::vector<Tool>& tools, const Context& context) {
  for (const Tool& tool : tools) {
    const std::string state = fmt::format("{}/state", tool.name);
    const std::string actions[] = {fmt::format("{}/{}", tool.name, gripper_action),
                                   fmt::format("{}/{}", tool.name, parallel_gripper_action)};
    const auto warn_of = [&](Position at, std::string_view name, std::string_view what) {
      warn_of_taken_place(at, name, fmt::format("{} of the tool '{}'", what, tool.name),
                          "give the point or the tool another name", context);
    };
    for (const DraftPoint& draft : points) {
      if (draft.point.name == state) warn_of(draft.name_at, state, "the topic");
      for (const std::string& action : actions)
        if (takes_place_of(draft.point.name, action)) warn_of(draft.name_at, action, "an action");
    }
  }
}

void warn_of_joint_names(const DraftPoints& points, const Context& context) {
  for (const DraftPoint& draft : points) {
    if (draft.point.name == joint_states_topic)
      warn_of_taken_place(draft.name_at, joint_states_topic, "the topic with the positions of tools and axes",
                          "give the point another name if programs need that topic", context);
    if (takes_place_of(draft.point.name, trajectory_action))
      warn_of_taken_place(draft.name_at, trajectory_action, "the action that moves tools and axes",
                          "give the point another name if programs need that action", context);
  }
}

}  // namespace coupler::loader
