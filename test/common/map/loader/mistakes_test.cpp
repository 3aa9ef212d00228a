// SPDX-License-Identifier: Apache-2.0
// What people type who have a manual and no time, in test/maps/mistakes: what is typed, what the loader says,
// and why that is right. The format is in its README.md.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>

#include "coupler/map/fingerprint.hpp"
#include "test/common/map/loader/loaded.hpp"
#include "test/support/paths.hpp"

namespace coupler {
namespace {

namespace fs = std::filesystem;

struct Mistake {
  std::string place;  ///< FILE:LINE of the table
  std::string where;
  std::string typed;
  std::string said;  ///< one message a line
  std::string read;  ///< the points of an accepted map, a canonical line each
  std::string why;
};

std::string unescaped(std::string text) {
  for (const auto& [code, character] : {std::pair{"\\n", '\n'}, std::pair{"\\t", '\t'}})
    for (std::size_t at = text.find(code); at != std::string::npos; at = text.find(code))
      text.replace(at, 2, 1, character);
  return text;
}

std::vector<Mistake> mistakes() {
  std::vector<Mistake> found;
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(test::in_tree("test/maps/mistakes")))
    if (entry.path().extension() == ".txt") files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  for (const fs::path& file : files) {
    std::ifstream in(file);
    int number = 0;
    for (std::string line; std::getline(in, line);) {
      ++number;
      if (line.empty() || line[0] == '#') continue;
      if (line.compare(0, 4, "  > ") == 0) {
        found.back().said += line.substr(4) + '\n';
      } else if (line.compare(0, 4, "  = ") == 0) {
        found.back().read += line.substr(4) + '\n';
      } else if (line.compare(0, 2, "  ") == 0) {
        found.back().why += line.substr(2);
      } else {
        const std::size_t colon = line.find(": ");
        const std::string place = file.filename().string() + ':' + std::to_string(number);
        found.push_back({place, line.substr(0, colon), unescaped(line.substr(colon + 2)), "", "", ""});
      }
    }
  }
  return found;
}

/// The map with no key that ros-modbus-device-driver would not know, as a newcomer's is.
std::string map_of(const Mistake& mistake) {
  if (mistake.where == "file") return mistake.typed;
  if (mistake.where == "top") return "name: press\n" + mistake.typed + "\nmapping: {coils: {valve: 0}}\n";
  if (mistake.where == "mapping") return "name: press\nmapping:\n  " + mistake.typed + '\n';
  return "name: press\nmapping:\n  " + mistake.where + ":\n    p: " + mistake.typed + '\n';
}

std::string text_of(const std::vector<Diagnostic>& diagnostics) {
  std::string text;
  for (const Diagnostic& d : diagnostics)
    text += std::string(d.severity == Diagnostic::Severity::error ? "error" : "warning") + ": " + d.what +
            "; " + d.remedy + '\n';
  return text;
}

TEST(Mistakes, Each_is_answered_as_the_table_says) {
  const auto table = mistakes();
  EXPECT_GE(table.size(), 100U);
  for (const Mistake& mistake : table) {
    const std::string said = text_of(load_map(map_of(mistake), "m").diagnostics);
    constexpr std::string_view goes_on = "…\n";
    const std::size_t end = mistake.said.size() - std::min(mistake.said.size(), goes_on.size());
    if (mistake.said.compare(end, std::string::npos, goes_on) == 0)
      EXPECT_EQ(said.substr(0, end), mistake.said.substr(0, end)) << mistake.place;
    else
      EXPECT_EQ(said, mistake.said) << mistake.place;
    EXPECT_FALSE(mistake.why.empty()) << mistake.place;
  }
}

TEST(Mistakes, What_is_accepted_is_read_as_the_author_meant_it) {
  std::size_t accepted = 0;
  for (const Mistake& mistake : mistakes()) {
    const LoadResult loaded = load_map(map_of(mistake), "m");
    EXPECT_EQ(loaded.map ? canonical_text(loaded.map->map().points) : "", mistake.read) << mistake.place;
    accepted += loaded.map ? 1 : 0;
  }
  EXPECT_GE(accepted, 30U);
}

}  // namespace
}  // namespace coupler
