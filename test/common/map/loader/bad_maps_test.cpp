// SPDX-License-Identifier: Apache-2.0
// One bad map for each rule, in test/maps/bad. Each says in its first comments what the loader must answer.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>

#include "coupler/base/version.hpp"
#include "test/common/map/loader/loaded.hpp"
#include "test/support/paths.hpp"

namespace coupler {
namespace {

namespace fs = std::filesystem;

std::vector<std::string> bad_maps() {
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(test::in_tree("test/maps/bad")))
    if (entry.path().extension() != ".lock") names.push_back(entry.path().filename().string());
  std::sort(names.begin(), names.end());
  return names;
}

std::string replaced(std::string text, const std::string& what, const std::string& by) {
  for (std::size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + by.size()))
    text.replace(at, what.size(), by);
  return text;
}

/// "# expect: LINE:COLUMN: …" or "// expect: …", as the loader would say it of a file called "map"; of its
/// lock
/// "# expect: .lock:LINE:COLUMN: …". VERSION stands for that of coupler.
std::string expectations(const std::string& path) {
  std::ifstream in(path);
  std::string result;
  const std::string mark = " expect: ";
  for (std::string line; std::getline(in, line);) {
    const std::size_t at = line.find(mark);
    if (at == 1 || at == 2)
      result += (line[at + mark.size()] == '.' ? "map" : "map:") + line.substr(at + mark.size()) + '\n';
  }
  return replaced(result, "VERSION", std::string(version));
}

class BadMap : public testing::TestWithParam<std::string> {};

TEST_P(BadMap, Is_answered_with_exactly_the_lines_that_it_expects) {
  const std::string path = test::in_tree("test/maps/bad/") + GetParam();
  const std::string expected = expectations(path);
  ASSERT_NE(expected, "") << "the file says nothing about what to expect";
  const LoadResult result = load_map_file(path);
  EXPECT_EQ(replaced(test::text_of(result.diagnostics), path, "map"), expected);
  EXPECT_EQ(result.map == nullptr, has_errors(result.diagnostics));
}

TEST(Notes, Both_places_of_an_overlap_are_quoted) {
  const LoadResult result = load_map("name: a\nmapping:\n  coils:\n    lamp: 0\n    valve: 0\n", "a.yaml");
  ASSERT_EQ(result.diagnostics.size(), 1U);
  EXPECT_EQ(
      render(result.diagnostics[0], Colour::no),
      "a.yaml:5:12: error: 'valve' (coils 0) overlaps 'lamp' (coils 0, line 4); give one of the two another "
      "address\n"
      "    5 |     valve: 0\n"
      "      |            ^\n"
      "a.yaml:4:11: note: the other is here\n"
      "    4 |     lamp: 0\n"
      "      |           ^\n");
}

std::string test_name(const testing::TestParamInfo<std::string>& map) {
  std::string name = map.param;
  std::replace(name.begin(), name.end(), '.', '_');
  return name;
}

INSTANTIATE_TEST_SUITE_P(Maps, BadMap, testing::ValuesIn(bad_maps()), test_name);

}  // namespace
}  // namespace coupler
