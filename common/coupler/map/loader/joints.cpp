// SPDX-License-Identifier: Apache-2.0
#include "coupler/map/loader/joints.hpp"

#include <fmt/format.h>

#include "coupler/codec/text.hpp"
#include "coupler/map/loader/names.hpp"

namespace coupler::loader {
namespace {

constexpr std::size_t most_of_a_kind = 64;

/// Returns what has the same name twice.
std::string_view both(const JointKind& a, const JointKind& b) {
  return a.key == b.key ? a.one : "tool and axis";
}

}  // namespace

Span<const Entry> Joints::entries(const JointKind& kind, const Reader& top) const {
  const auto& [key, one, an] = kind;
  const Entry* entry = top.find(key);
  if (entry == nullptr) return {};
  const std::string example = fmt::format("'{}: {}'", key, top.example(key));
  if (!check_map(*entry, fmt::format("'{0}' holds the {0}", key), "write them as in " + example, context_))
    return {};
  const std::size_t count = entry->children.size();
  if (count == 0)
    context_.problems.error(entry->key_at, fmt::format("'{}' has no {}", key, one),
                            "add one, as in " + example);
  if (count <= most_of_a_kind) return entry->children;
  context_.problems.error(
      entry->key_at, fmt::format("there are {} {}, and a map has at most {}", count, key, most_of_a_kind),
      "write the others into a second map of the device, with another name");
  return {};
}

bool Joints::check_name(const JointKind& kind, const Entry& entry) {
  const std::string& name = entry.key;
  const auto [first, is_new] = names_.emplace(name, Taken{name, kind, entry.key_at});
  if (!is_relative_ros_name(name) || name.find('/') != std::string::npos)
    context_.problems.error(entry.key_at, fmt::format("{} is not a valid name of {}", shown(name), kind.an),
                            "begin with a letter and use letters, digits and '_'");
  else if (name == wait_for_action)
    context_.problems.error(entry.key_at, fmt::format("'{}' is an action of the driver itself", name),
                            fmt::format("give the {} another name", kind.one));
  else if (!is_new)
    context_.problems.error(
        entry.key_at,
        fmt::format("'{}' is already the name of {}, in line {}", name, first->second.kind.an,
                    first->second.at.line),
        fmt::format("give every {} of the map a name of its own", both(kind, first->second.kind)),
        {{first->second.at, "the other is here"}});
  else
    return true;
  return false;
}

void Joints::check_joint(const JointKind& kind, const Reader& reader, const Entry& entry,
                         const std::string& usual) {
  const Entry* given = reader.find("joint");
  if (given != nullptr && given->kind != Entry::Kind::scalar) return;  // a problem already
  const Position at = given == nullptr ? entry.key_at : given->at;
  const std::string& name = given == nullptr ? usual : given->text;
  if (name.empty() || name.find(' ') != std::string::npos || !codec::is_plain_text(name))
    return context_.problems.error(at, fmt::format("{} is not a valid name of a joint", shown(name)),
                                   fmt::format("write one without blanks and control characters, as in "
                                               "'joint: {}'",
                                               reader.example("joint")));
  const auto [first, is_new] = joints_.emplace(name, Taken{entry.key, kind, at});
  if (is_new) return;
  const auto& [other, other_kind, other_at] = first->second;
  context_.problems.error(at,
                          fmt::format("{} is already the joint of the {} '{}', in line {}", shown(name),
                                      other_kind.one, other, other_at.line),
                          fmt::format("give each {} a joint of its own, as in 'joint: {}_joint'",
                                      both(kind, other_kind), entry.key),
                          {{other_at, "it is here"}});
}

}  // namespace coupler::loader
