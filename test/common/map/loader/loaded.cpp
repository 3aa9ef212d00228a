// SPDX-License-Identifier: Apache-2.0
#include "test/common/map/loader/loaded.hpp"

namespace coupler::test {

std::string text_of(const Diagnostics& diagnostics) {
  std::string text;
  for (const Diagnostic& diagnostic : diagnostics) text += to_string(diagnostic) + '\n';
  return text;
}

MapPtr load_clean(const std::string& text) {
  LoadResult result = load_map(text, "map.yaml");
  EXPECT_EQ(text_of(result.diagnostics), "");
  EXPECT_NE(result.map, nullptr);
  return result.map ? result.map : std::make_shared<OwnedMap>();
}

std::string map_of(const std::string& table, const std::string& points, const std::string& top) {
  return "name: press\n" + top + "\nmapping: {" + table + ": {" + points + "}}\n";
}

MapPtr load_with(const std::string& top) { return load_clean(map_of("coils", "valve: 0", top)); }

OnePoint::OnePoint(const std::string& table, const std::string& options, const std::string& top)
    : map_(load_clean(map_of(table, "p: " + options, top))) {
  EXPECT_EQ(map_->map().points.size(), 1U);
}

LoadResult load_with_lock(const std::string& text, LockUse use, std::optional<std::string> lock) {
  return load_map_with_lock(text, "m.yaml", {"m.yaml.lock", std::move(lock), use});
}

LoadResult renewed(const std::string& text, std::optional<std::string> lock) {
  LoadResult result = load_with_lock(text, LockUse::renew, std::move(lock));
  EXPECT_EQ(text_of(result.diagnostics), "");
  EXPECT_NE(result.map, nullptr);
  return result;
}

}  // namespace coupler::test
