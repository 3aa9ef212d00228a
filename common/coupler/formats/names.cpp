// SPDX-License-Identifier: Apache-2.0
#include "coupler/formats/names.hpp"

#include <unordered_map>

#include <fmt/format.h>

#include "coupler/formats/entries.hpp"
#include "coupler/map/loader/names.hpp"
#include "coupler/map/loader/scalar.hpp"
#include "coupler/map/table.hpp"

namespace coupler::formats {
namespace {

using loader::Entry;

constexpr std::size_t longest = 100;  // for a name that is mended: a topic stays readable

std::string valid(std::string_view name) {
  if (!loader::is_relative_ros_name(name)) return mended_name(name, "point");
  if (name == "online" || name == "status") return std::string(name) + "_point";  // the driver's own topics
  return std::string(name);
}

/// Names that are taken, and the line of the point that has each.
class Names {
 public:
  explicit Names(loader::Problems& problems) : problems_(problems) {}

  void mend(Entry& point) {
    const std::string wanted = valid(point.key);
    std::string name = wanted;
    int& last = last_.emplace(wanted, 1).first->second;
    while (!lines_.emplace(name, point.key_at.line).second) name = fmt::format("{}_{}", wanted, ++last);
    if (wanted != point.key)
      problems_.warning(point.key_at,
                        fmt::format("{} cannot name a point, it is now '{}'", loader::shown(point.key), name),
                        "rename it in the map if you like another name better");
    else if (name != wanted)
      problems_.warning(point.key_at,
                        fmt::format("{} is already the name of a point, in line {}; this one is now '{}'",
                                    loader::shown(wanted), lines_[wanted], name),
                        "give every point a name of its own");
    point.key = name;
  }

 private:
  loader::Problems& problems_;
  std::unordered_map<std::string, int> lines_;
  std::unordered_map<std::string, int> last_;  ///< number that was given behind a name
};

}  // namespace

std::string mended_name(std::string_view name, std::string_view prefix) {
  std::string out;
  for (const char c : name) {
    if (out.size() == longest) break;
    const bool keeps = loader::is_letter(c) || loader::is_digit(c);
    const bool joins = !out.empty() && out.back() != '_' && out.back() != '/';
    if (keeps)
      out += c;
    else if (joins)
      out += c == '/' ? '/' : '_';
  }
  while (!out.empty() && (out.back() == '_' || out.back() == '/')) out.pop_back();
  if (out.empty()) return std::string(prefix);
  return loader::is_letter(out.front()) ? out : fmt::format("{}_{}", prefix, out);
}

void mend_point_names(Entry& map, loader::Problems& problems) {
  Entry* mapping = find(map, "mapping");
  if (mapping == nullptr) return;
  Names names(problems);
  for (const Table table : tables)
    if (Entry* entry = find(*mapping, to_string(table)))
      for (Entry& point : entry->children) names.mend(point);
}

}  // namespace coupler::formats
