// SPDX-License-Identifier: Apache-2.0
#include "coupler/map/loader/without_keys.hpp"

#include <algorithm>
#include <cstddef>
#include <optional>

#include "coupler/map/loader/document.hpp"
#include "coupler/map/loader/problems.hpp"
#include "coupler/map/loader/source_text.hpp"

namespace coupler {
namespace {

std::size_t line_start(std::string_view text, int line) {
  std::size_t at = 0;
  for (int passed = 1; passed < line; ++passed) at = text.find('\n', at) + 1;
  return at;
}

std::size_t offset_of(std::string_view text, loader::Position at) {
  return line_start(text, at.line) + static_cast<std::size_t>(at.column - 1);
}

/// Without the entry `i` of the root, whose entries stand in braces.
std::string without_braced(const std::string& text, const loader::Entry& root, std::size_t i) {
  std::string bare = text;  // without comments, at the same places
  loader::Problems none("");
  loader::blank_comments(bare, none);
  std::size_t begin = offset_of(text, root.children[i].key_at);
  if (i + 1 < root.children.size())
    return text.substr(0, begin) + text.substr(offset_of(text, root.children[i + 1].key_at));
  if (i > 0) begin = bare.rfind(',', begin);
  return text.substr(0, begin) + text.substr(std::min(bare.rfind('}'), text.size()));
}

std::string without_block(const std::string& text, const loader::Entry& root, std::size_t i) {
  const std::size_t begin = line_start(text, root.children[i].key_at.line);
  const bool is_last = i + 1 == root.children.size();
  const std::size_t end = is_last ? text.size() : line_start(text, root.children[i + 1].key_at.line);
  return text.substr(0, begin) + text.substr(end);
}

}  // namespace

std::string without_keys(std::string_view text, const std::vector<std::string_view>& keys) {
  std::string rest(loader::without_byte_order_mark(text));
  for (;;) {
    loader::Problems none("");
    const auto root = loader::parse_document(rest, none);
    if (!root) return rest;
    const auto found = std::find_if(root->children.begin(), root->children.end(), [&](const auto& entry) {
      return std::find(keys.begin(), keys.end(), entry.key) != keys.end();
    });
    if (found == root->children.end()) return rest;
    const auto i = static_cast<std::size_t>(found - root->children.begin());
    const bool is_braced = rest[offset_of(rest, root->at)] == '{';  // may stand behind "---"
    rest = is_braced ? without_braced(rest, *root, i) : without_block(rest, *root, i);
  }
}

}  // namespace coupler
