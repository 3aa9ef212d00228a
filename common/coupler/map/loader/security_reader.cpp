// SPDX-License-Identifier: Apache-2.0
// `security:`, who may read and write which points.
#include <algorithm>

#include <fmt/format.h>

#include "coupler/codec/text.hpp"
#include "coupler/map/fingerprint.hpp"
#include "coupler/map/loader/map_reader.hpp"
#include "coupler/map/loader/scalar.hpp"
#include "coupler/map/name_pattern.hpp"
#include "coupler/map/nearest.hpp"

namespace coupler::loader {
namespace {

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
    return Role{context_.map.keep(std::string(entry.key)), context_.map.keep(rights),
                reads_all(reader.find("read"), rights)};
  }

 private:
  static std::uint8_t bit(Right right) { return static_cast<std::uint8_t>(right); }

  /// If no point can be read, only `all` says so.
  bool reads_all(const Entry* read, const std::vector<std::uint8_t>& rights) const {
    if (read == nullptr) return false;
    if (read->kind == Entry::Kind::scalar) return read->text == "all";
    for (std::size_t i = 0; i < points_.size(); ++i)
      if (is_readable(points_[i]) && (rights[i] & bit(Right::read)) == 0) return false;
    return !read->children.empty();
  }

  bool check_name(const Entry& entry) const {
    const bool is_good =
        !entry.key.empty() && entry.key.size() <= longest_role_name && codec::is_plain_text(entry.key);
    if (!is_good)
      context_.problems.error(entry.key_at, "a role's name has 1 to 64 bytes and no control characters",
                              "give it another name, as in 'operator'");
    return is_good;
  }

  /// `all`, `none`, or patterns.
  void grant(const Entry& value, std::string_view key, Right right, std::vector<std::uint8_t>& rights) const {
    if (value.kind == Entry::Kind::scalar && (value.text == "all" || value.text == "none")) {
      // All is all: a register that is shared with a point which cannot be read can be read all the same.
      if (value.text == "all")
        for (std::uint8_t& each : rights) each |= bit(right);
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

/// The key's value is the name of a role, or none.
std::optional<std::uint16_t> read_role(const Reader& reader, std::string_view key,
                                       const std::vector<Role>& roles, const Context& context) {
  const Entry* entry = reader.find(key);
  if (entry == nullptr) return std::nullopt;
  std::string_view wanted = "none";
  reader.text(key, wanted);
  std::vector<std::string_view> names;
  std::optional<std::uint16_t> found;
  for (std::size_t i = 0; i < roles.size(); ++i) {
    if (roles[i].name == wanted) found = static_cast<std::uint16_t>(i);
    names.push_back(roles[i].name);
  }
  if (found && wanted == "none")
    context.problems.error(entry->at, fmt::format("'{}: none' means no role, but one has that name", key),
                           "give the role another name");
  else if (!found && wanted != "none")
    context.problems.error(entry->at, fmt::format("no role is called {}", shown(wanted)),
                           suggestion(wanted, names));
  return found;
}

/// Checks the keys for TLS: none of them, or all.
void read_tls(const Reader& reader, const Entry& section, std::uint16_t plain_port, Security& security,
              const Context& context) {
  CredentialFiles& files = security.files;
  files.folder = context.folder;
  const std::pair<std::string_view, std::string_view*> keys[] = {{"certificate", &files.certificate},
                                                                 {"key", &files.key},
                                                                 {"ca", &files.ca},
                                                                 {"revoked", &files.revoked}};
  for (const auto& [key, path] : keys) {
    reader.text(key, *path);
    check_pem_path(reader, key, context);
  }
  reader.integer("port", security.port);
  if (reader.has("certificate") && security.port == plain_port)
    context.problems.error(reader.has("port") ? reader.find("port")->at : section.key_at,
                           fmt::format("port {} is that of clients without TLS", plain_port),
                           "give TLS another port; 802 is the usual one");
  if (reader.has("certificate")) {
    for (const std::string_view key : {"key", "ca"})
      if (reader.lacks(key))
        context.problems.error(
            section.key_at, fmt::format("'security' has a 'certificate', but no '{}'", key),
            fmt::format("add the path of that file, as in '{}: {}'", key, reader.example(key)));
    return;
  }
  for (const std::string_view key : {"key", "ca", "revoked", "port", "no_role"})
    if (const Entry* entry = reader.find(key))
      context.problems.error(
          entry->key_at,
          fmt::format("'{}' is for clients with TLS, and 'security' has no 'certificate'", key),
          "add 'certificate', 'key' and 'ca', or remove it");
}

}  // namespace

void check_pem_path(const Reader& section, std::string_view key, const Context& context) {
  const Entry* entry = section.find(key);
  if (entry == nullptr) return;
  if (entry->text.empty())
    context.problems.error(
        entry->at, fmt::format("'{}' is empty", key),
        fmt::format("write the path of that file, as in '{}: {}'", key, section.example(key)));
  if (entry->text.find("-----BEGIN") == std::string_view::npos) return;
  context.problems.error(
      entry->at, fmt::format("'{}' is PEM text, but a map has no certificates and keys", key),
      fmt::format("write it to a file, and its path here, as in '{}: {}'", key, section.example(key)));
}

Security read_security(const Reader& top, const DraftPoints& drafts, std::uint16_t plain_port,
                       const Context& context) {
  if (context.served) return {};  // it is the node's own
  const auto reader = top.inside("security", "a map with 'roles'");
  if (!reader) return {};
  const Entry* entry = reader->find("roles");
  if (entry == nullptr) {
    if (!reader->lacks("roles")) return {};
    context.problems.error(top.find("security")->key_at, "'security' has no 'roles'",
                           "add them, as in 'roles: {viewer: {read: all}}'");
    return {};
  }
  if (!check_map(*entry, "'roles' holds the roles", "write them as in 'roles: {viewer: {read: all}}'",
                 context))
    return {};
  if (entry->children.empty())
    context.problems.error(entry->key_at, "'roles' has no role",
                           "add one, as in 'roles: {viewer: {read: all}}'");
  if (entry->children.size() > most_roles) {
    context.problems.error(
        entry->key_at,
        fmt::format("there are {} roles, and a map has at most {}", entry->children.size(), most_roles),
        "give clients with the same rights one role");
    return {};
  }
  const std::vector<Point> points = in_order(drafts);
  const RoleReader role_reader(points, context);
  std::vector<Role> roles;
  for (const Entry& child : entry->children)
    if (const auto role = role_reader.read(child)) roles.push_back(*role);
  if (roles.size() != entry->children.size()) return {};
  Security security;
  security.plain = read_role(*reader, "plain", roles, context);
  security.no_role = read_role(*reader, "no_role", roles, context);
  read_tls(*reader, *top.find("security"), plain_port, security, context);
  security.roles = context.map.keep(roles);
  return security;
}

}  // namespace coupler::loader
