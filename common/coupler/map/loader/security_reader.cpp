// SPDX-License-Identifier: Apache-2.0
// `security:`, who may read and write which points.
#include <fnmatch.h>

#include <algorithm>

#include <fmt/format.h>

#include "coupler/map/fingerprint.hpp"
#include "coupler/map/loader/map_reader.hpp"
#include "coupler/map/loader/nearest.hpp"
#include "coupler/map/loader/scalar.hpp"

namespace coupler::loader {
namespace {

constexpr std::size_t longest_role_name = 64;  // bytes, as in a certificate

bool matches(std::string_view pattern, std::string_view name) {
  return ::fnmatch(std::string(pattern).c_str(), std::string(name).c_str(), 0) == 0;
}

bool is_possible(const Point& point, Right right) {
  return right == Right::read ? is_readable(point) : is_writable(point);
}

/// Reads roles over points that are in the order of the map.
class RoleReader {
 public:
  RoleReader(const std::vector<Point>& points, const Context& context) : points_(points), context_(context) {}

  std::optional<Role> read(const Entry& entry) const {
    if (!check_name(entry)) return std::nullopt;
    if (!check_map(entry, fmt::format("the role '{}' holds 'read' and 'write'", entry.key),
                   "write it as in 'viewer: {read: all}'", context_))
      return std::nullopt;
    const Reader reader(entry, Section::role, context_);
    std::vector<std::uint8_t> rights(points_.size(), 0);
    for (const auto& [key, right] : {std::pair("read", Right::read), std::pair("write", Right::write)})
      if (const Entry* value = reader.find(key)) grant(*value, key, right, rights);
    bool reads_all = true;
    for (std::size_t i = 0; i < points_.size(); ++i)
      reads_all = reads_all && (!is_readable(points_[i]) || (rights[i] & bit(Right::read)) != 0);
    return Role{context_.map.keep(std::string(entry.key)), context_.map.keep(rights), reads_all};
  }

 private:
  static std::uint8_t bit(Right right) { return static_cast<std::uint8_t>(right); }

  bool check_name(const Entry& entry) const {
    const bool is_good = !entry.key.empty() && entry.key.size() <= longest_role_name &&
                         std::none_of(entry.key.begin(), entry.key.end(), [](char c) {
                           return static_cast<unsigned char>(c) < ' ' || c == '\x7F';
                         });
    if (!is_good)
      context_.problems.error(entry.key_at, "a role's name has 1 to 64 bytes and no control characters",
                              "give it another name, as in 'operator'");
    return is_good;
  }

  /// `all`, `none`, or patterns.
  void grant(const Entry& value, std::string_view key, Right right, std::vector<std::uint8_t>& rights) const {
    if (value.kind == Entry::Kind::scalar && (value.text == "all" || value.text == "none")) {
      if (value.text == "all") grant_matching("*", right, rights);
      return;
    }
    if (value.kind != Entry::Kind::list) {
      context_.problems.error(value.at,
                              fmt::format("'{}' is all, none or a list of points, not {}", key, shown(value)),
                              fmt::format("write it as in '{}: [lamp, \"valve_*\"]'", key));
      return;
    }
    for (const Entry& pattern : value.children)
      if (pattern.kind != Entry::Kind::scalar)
        context_.problems.error(pattern.at,
                                fmt::format("'{}' lists names of points, not {}", key, shown(pattern)),
                                fmt::format("write it as in '{}: [lamp, \"valve_*\"]'", key));
      else if (!grant_matching(pattern.text, right, rights))
        nothing_matches(pattern, right);
  }

  bool grant_matching(std::string_view pattern, Right right, std::vector<std::uint8_t>& rights) const {
    bool found = false;
    for (std::size_t i = 0; i < points_.size(); ++i) {
      if (!is_possible(points_[i], right) || !matches(pattern, points_[i].name)) continue;
      rights[i] |= bit(right);
      found = true;
    }
    return found;
  }

  void nothing_matches(const Entry& pattern, Right right) const {
    std::vector<std::string_view> names;
    bool exists = false;
    for (const Point& point : points_) {
      if (is_possible(point, right)) names.push_back(point.name);
      exists = exists || matches(pattern.text, point.name);
    }
    const std::string_view done = right == Right::read ? "read" : "written";
    if (exists)
      context_.problems.error(pattern.at, fmt::format("{} cannot be {}", shown(pattern.text), done),
                              "remove it from the list");
    else
      context_.problems.error(
          pattern.at, fmt::format("no point is called {}", shown(pattern.text)),
          nearest_or(pattern.text, names, "write the name of a point, or a pattern as \"valve_*\""));
  }

  const std::vector<Point>& points_;
  const Context& context_;
};

std::vector<Point> in_order(const DraftPoints& drafts) {
  std::vector<Point> points;
  points.reserve(drafts.size());
  for (const DraftPoint& draft : drafts) points.push_back(draft.point);
  std::sort(points.begin(), points.end(), canonical_less);
  return points;
}

std::optional<std::uint16_t> read_plain(const Reader& reader, const std::vector<Role>& roles,
                                        const Context& context) {
  std::string_view plain = "none";
  reader.text("plain", plain);
  std::vector<std::string_view> names;
  for (std::size_t i = 0; i < roles.size(); ++i) {
    if (roles[i].name == plain) return static_cast<std::uint16_t>(i);
    names.push_back(roles[i].name);
  }
  if (const Entry* entry = reader.find("plain"); entry != nullptr && plain != "none")
    context.problems.error(entry->at, fmt::format("no role is called {}", shown(plain)),
                           suggestion(plain, names));
  return std::nullopt;
}

}  // namespace

Security read_security(const Reader& top, const DraftPoints& drafts, const Context& context) {
  if (context.served) return {};  // it is the node's own
  const auto reader = top.inside("security", "a map with 'roles'");
  if (!reader) return {};
  const Entry* entry = reader->find("roles");
  if (entry == nullptr) {
    context.problems.error(top.find("security")->key_at, "'security' has no 'roles'",
                           "add them, as in 'roles: {viewer: {read: all}}'");
    return {};
  }
  if (!check_map(*entry, "'roles' holds the roles", "write them as in 'roles: {viewer: {read: all}}'",
                 context))
    return {};
  const std::vector<Point> points = in_order(drafts);
  const RoleReader role_reader(points, context);
  std::vector<Role> roles;
  for (const Entry& child : entry->children)
    if (const auto role = role_reader.read(child)) roles.push_back(*role);
  if (roles.size() != entry->children.size()) return {};
  Security security;
  security.plain = read_plain(*reader, roles, context);
  security.roles = context.map.keep(roles);
  return security;
}

}  // namespace coupler::loader
