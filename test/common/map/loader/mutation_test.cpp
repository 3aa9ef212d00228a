// SPDX-License-Identifier: Apache-2.0
// No file makes the loader throw, crash or contradict itself: random damage to good and bad maps.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>

#include "test/common/map/loader/loaded.hpp"
#include "test/support/paths.hpp"

namespace coupler {
namespace {

std::vector<std::string> seeds() {
  std::vector<std::string> texts;
  for (const char* folder : {"test/maps", "test/maps/origin", "test/maps/bad"})
    for (const auto& file : std::filesystem::directory_iterator(test::in_tree(folder))) {
      if (!file.is_regular_file()) continue;
      std::ifstream in(file.path(), std::ios::binary);
      texts.emplace_back(std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>());
    }
  std::sort(texts.begin(), texts.end());  // a folder has no order
  return texts;
}

class Mutator {
 public:
  explicit Mutator(std::vector<std::string> texts) : texts_(std::move(texts)) {}

  std::string next() {
    std::string text = texts_[below(texts_.size())];
    for (std::size_t changes = 1 + below(4); changes > 0 && !text.empty(); --changes) change(text);
    return text;
  }

 private:
  std::size_t below(std::size_t limit) {
    return std::uniform_int_distribution<std::size_t>(0, limit - 1)(random_);
  }

  /// Any line, with its newline.
  std::string line_of(const std::string& text) {
    const std::size_t start = text.rfind('\n', below(text.size())) + 1;
    return text.substr(start, text.find('\n', start) + 1 - start);
  }

  void change(std::string& text) {
    // clang-format off
    static constexpr std::string_view pieces[] = {
        "{", "}", "[", "]", ":", ",", "\"", "'", "\n", "#", "//", "/*", "- ", "? ", "| ", "&a ", "*a ", "!t ", "<<: ",
        "null", "---\n", "-1", "99999999999999999999", "\\", "\t", "\\ud83d", "%", "address: "};
    // clang-format on
    const std::size_t at = below(text.size());
    switch (below(6)) {
      case 0: text.erase(at, 1 + below(12)); break;
      case 1: text.insert(at, pieces[below(std::size(pieces))]); break;
      case 2: text[at] = static_cast<char>(below(256)); break;
      case 3: text.insert(at, text.substr(below(text.size()), 1 + below(60))); break;
      case 4: text.insert(text.find('\n', at) + 1, line_of(texts_[below(texts_.size())])); break;
      default: text.resize(at); break;
    }
  }

  std::vector<std::string> texts_;
  std::mt19937 random_{20240521};  // the same damage in every run
};

/// What is wrong with the answer; empty: nothing.
std::string wrong_of(const LoadResult& result, const std::string& text) {
  if ((result.map == nullptr) != has_errors(result.diagnostics)) return "a map with errors, or none without";
  const int lines = 1 + static_cast<int>(std::count(text.begin(), text.end(), '\n'));
  for (const Diagnostic& diagnostic : result.diagnostics) {
    if (diagnostic.line < 1 || diagnostic.line > lines || diagnostic.column < 1)
      return "a place that is not in the file: " + to_string(diagnostic);
    if (diagnostic.what.empty() || diagnostic.remedy.empty()) return "a diagnostic without words";
  }
  return {};
}

/// The same of the text that a node serves.
std::string wrong_when_served(const LoadResult& result, const std::string& text) {
  if (result.map == nullptr) return {};
  const Map& map = result.map->map();
  if (result.lock.text.empty() && map.text != text) return "another text without need";
  const LoadResult served = load_map(map.text, "map");
  if (served.map == nullptr)
    return "it does not load: " + std::string(map.text) + test::text_of(served.diagnostics);
  return served.map->map().fingerprint == map.fingerprint ? "" : "another map: " + std::string(map.text);
}

TEST(Mutation, A_damaged_map_is_either_loaded_or_answered) {
  Mutator mutator(seeds());
  for (int i = 0; i < 20000; ++i) {
    const std::string text = mutator.next();
    const LoadResult result = load_map_with_lock(text, "map", {"map.lock", std::nullopt, LockUse::renew});
    ASSERT_EQ(wrong_of(result, text), "") << text;
    ASSERT_EQ(wrong_when_served(result, text), "") << text;
  }
}

}  // namespace
}  // namespace coupler
