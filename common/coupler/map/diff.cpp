// SPDX-License-Identifier: Apache-2.0
#include "coupler/map/diff.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <sstream>

#include <fmt/format.h>

#include "coupler/map/fingerprint.hpp"

namespace coupler {
namespace {

/// The fields of canonical_line(), in its order.
constexpr std::array<std::string_view, 12> fields{
    "table",    "address",          "part",  "name",  "type", "order", "count", "length",
    "encoding", "ignore_byteorder", "scale", "access"};

std::vector<std::string> split(const std::string& line) {
  std::istringstream words(line);
  std::vector<std::string> result;
  for (std::string word; words >> word;) result.push_back(word);
  return result;
}

std::string place(const Point& point) {
  return fmt::format("{} {}, {}", to_string(point.table), point.address, to_string(point.format.type));
}

/// Returns the value as a map has it. The hexadecimal floats of the canonical line are for machines.
std::string scale(const Point& point) {
  if (!point.scale.present()) return "none";
  const auto& [gain, offset, exponent_of] = point.scale;
  if (offset == 0 && exponent_of.empty()) return fmt::to_string(gain);
  return fmt::format("{{gain: {}, offset: {}{}{}}}", gain, offset,
                     exponent_of.empty() ? "" : ", exponent_of: ", exponent_of);
}

std::vector<FieldChange> changed_fields(const Point& older, const Point& newer) {
  const auto a = split(canonical_line(older));
  const auto b = split(canonical_line(newer));
  std::vector<FieldChange> changes;
  for (std::size_t i = 0; i < fields.size(); ++i) {
    if (a[i] == b[i]) continue;
    if (fields[i] == "scale")
      changes.push_back({fields[i], scale(older), scale(newer)});
    else
      changes.push_back({fields[i], a[i], b[i]});
  }
  return changes;
}

std::string text_of(const std::vector<FieldChange>& changes) {
  std::string text;
  for (const auto& [field, older, newer] : changes)
    text += fmt::format("{}{} {} -> {}", text.empty() ? "" : ", ", field, older, newer);
  return text;
}

std::map<std::string_view, const Point*> by_name(const Map& map) {
  std::map<std::string_view, const Point*> result;
  for (const Point& point : map.points) result.emplace(point.name, &point);
  return result;
}

}  // namespace

std::vector<Difference> diff(const Map& older, const Map& newer) {
  std::vector<Difference> result;
  const auto old_points = by_name(older);
  const auto new_points = by_name(newer);
  for (const Point& point : older.points) {
    const auto found = new_points.find(point.name);
    if (found == new_points.end()) {
      result.push_back({Difference::Kind::missing, std::string(point.name), place(point)});
    } else if (auto changes = changed_fields(point, *found->second); !changes.empty()) {
      result.push_back(
          {Difference::Kind::changed, std::string(point.name), text_of(changes), std::move(changes)});
    }
  }
  for (const Point& point : newer.points)
    if (old_points.count(point.name) == 0)
      result.push_back({Difference::Kind::added, std::string(point.name), place(point)});
  return result;
}

bool is_subset(const Map& known, const Map& device) {
  const auto differences = diff(known, device);
  return std::none_of(differences.begin(), differences.end(),
                      [](const Difference& difference) { return is_breaking(difference.kind); });
}

std::string to_string(const Difference& difference) {
  switch (difference.kind) {
    case Difference::Kind::missing:
      return fmt::format("- {}: missing ({})", difference.point, difference.what);
    case Difference::Kind::added: return fmt::format("+ {}: added ({})", difference.point, difference.what);
    case Difference::Kind::changed: return fmt::format("~ {}: {}", difference.point, difference.what);
  }
  return {};
}

}  // namespace coupler
