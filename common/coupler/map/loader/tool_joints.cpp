// SPDX-License-Identifier: Apache-2.0
#include "coupler/map/loader/tool_joints.hpp"

#include <fmt/format.h>

#include "coupler/codec/text.hpp"
#include "coupler/map/joint.hpp"

namespace coupler::loader {

void ToolJoints::check(const Reader& reader, const Entry& entry, const Tool& tool) {
  const Entry* given = reader.find("joint");
  if (given != nullptr && given->kind != Entry::Kind::scalar) return;  // a problem already
  const Position at = given == nullptr ? entry.key_at : given->at;
  const std::string name = given == nullptr ? joint_name(head_, tool) : given->text;
  if (name.empty() || name.find(' ') != std::string::npos || !codec::is_plain_text(name))
    return context_.problems.error(at, fmt::format("{} is not a valid name of a joint", shown(name)),
                                   "write one without blanks and control characters, as in 'joint: " +
                                       std::string(reader.example("joint")) + "'");
  const auto [first, is_new] = taken_.emplace(name, Taken{tool.name, at});
  if (!is_new)
    context_.problems.error(
        at,
        fmt::format("{} is already the joint of the tool '{}', in line {}", shown(name), first->second.tool,
                    first->second.at.line),
        fmt::format("give each tool a joint of its own, as in 'joint: {}_joint'", tool.name),
        {{first->second.at, "it is here"}});
}

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

}  // namespace coupler::loader
