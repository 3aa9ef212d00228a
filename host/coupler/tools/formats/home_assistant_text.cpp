// SPDX-License-Identifier: Apache-2.0
#include "coupler/tools/formats/home_assistant_text.hpp"

#include <algorithm>
#include <map>
#include <set>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "coupler/map/loader/scalar.hpp"

namespace coupler::formats {
namespace {

using loader::Entry;
using loader::Position;
using loader::Problems;
using loader::shown;

std::string_view first_line(std::string_view text) {
  return text.substr(0, std::min(text.find('\n'), text.size()));
}

constexpr std::string_view blanks_and_quotes = " \t\r\"'";

std::string_view without_quotes(std::string_view text) {
  const std::size_t begin = text.find_first_not_of(blanks_and_quotes);
  if (begin == std::string_view::npos) return {};
  return text.substr(begin, text.find_last_not_of(blanks_and_quotes) - begin + 1);
}

/// "modbus", and "modbus second" of a configuration in several parts.
bool is_modbus_key(std::string_view key) { return key == "modbus" || key.substr(0, 7) == "modbus "; }

/// The line in the text, from 0, of the first `modbus:` below another key, as in a package.
std::optional<int> line_of_nested_key(std::string_view text) {
  int number = 0;
  for (std::string_view rest = text; !rest.empty(); ++number) {
    const std::string_view line = first_line(rest);
    rest.remove_prefix(std::min(line.size() + 1, rest.size()));
    const std::size_t colon = line.find(':');
    const bool is_below = !line.empty() && (line[0] == ' ' || line[0] == '\t');
    if (!is_below || colon == std::string_view::npos) continue;
    const std::string_view value = without_quotes(line.substr(colon + 1));
    const bool may_be_hubs =
        value.empty() || std::string_view("#[{!&*").find(value[0]) != std::string_view::npos;
    if (may_be_hubs && is_modbus_key(without_quotes(line.substr(0, colon)))) return number;
  }
  return std::nullopt;
}

/// A key at the beginning of a line, and the lines until the next one.
struct Block {
  std::string_view key;
  std::string_view text;
  bool keep = false;
};

std::vector<Block> blocks_of(std::string_view text) {
  std::vector<Block> blocks(1);
  for (std::string_view rest = text; !rest.empty();) {
    const std::string_view line = first_line(rest);
    const bool begins_key = !line.empty() &&
                            std::string_view(" \t#\r").find(line[0]) == std::string_view::npos &&
                            line.substr(0, 2) != "- " && line != "-";
    if (begins_key) blocks.push_back({without_quotes(line.substr(0, line.find(':'))), rest.substr(0, 0)});
    const std::size_t size = std::min(line.size() + 1, rest.size());
    Block& block = blocks.back();
    block.text = {block.text.empty() ? rest.data() : block.text.data(), block.text.size() + size};
    if (begins_key && line.find(':') == std::string_view::npos) block.key = {};
    rest.remove_prefix(size);
  }
  return blocks;
}

/// The names behind `mark` where a value may stand: '&' of anchors, '*' of aliases.
std::vector<std::string_view> names_behind(char mark, std::string_view text) {
  std::vector<std::string_view> names;
  for (std::size_t at = text.find(mark); at != std::string_view::npos; at = text.find(mark, at + 1)) {
    if (at > 0 && std::string_view(" \t\n,[").find(text[at - 1]) == std::string_view::npos) continue;
    const std::size_t end = std::min(text.find_first_of(" \t\r\n,[]{}", at), text.size());
    if (end > at + 1) names.push_back(text.substr(at + 1, end - at - 1));
  }
  return names;
}

/// Where the hubs stand.
enum class Below { key, packages, nothing };

Below place_of_hubs(const std::vector<Block>& blocks) {
  if (std::any_of(blocks.begin(), blocks.end(), [](const Block& block) { return is_modbus_key(block.key); }))
    return Below::key;
  const auto has_nested = [](const Block& block) {
    return !block.key.empty() && line_of_nested_key(block.text);
  };
  return std::any_of(blocks.begin(), blocks.end(), has_nested) ? Below::packages : Below::nothing;
}

/// Keeps the blocks with hubs, and those with the anchors that kept blocks have aliases of.
void choose_blocks(std::vector<Block>& blocks, Below below) {
  std::multimap<std::string_view, Block*> anchors;
  std::vector<Block*> next;
  for (Block& block : blocks) {
    block.keep = below == Below::key ? is_modbus_key(block.key) : line_of_nested_key(block.text).has_value();
    if (block.keep)
      next.push_back(&block);
    else
      for (const std::string_view name : names_behind('&', block.text)) anchors.emplace(name, &block);
  }
  while (!next.empty()) {
    const Block* block = next.back();
    next.pop_back();
    for (const std::string_view name : names_behind('*', block->text)) {
      const auto [begin, end] = anchors.equal_range(name);
      for (auto found = begin; found != end; ++found)
        if (!std::exchange(found->second->keep, true)) next.push_back(found->second);
      anchors.erase(begin, end);
    }
  }
}

/// Tells of packages beside `modbus:`.
void tell_packages(const std::vector<Block>& blocks, Problems& problems) {
  int line = 1;
  for (const Block& block : blocks) {
    const auto nested = block.keep ? std::nullopt : line_of_nested_key(block.text);
    if (nested)
      problems.warning({line + *nested, 1}, "the hubs of this 'modbus:' below another key are not read",
                       "give a file that has this part only");
    line += static_cast<int>(std::count(block.text.begin(), block.text.end(), '\n'));
  }
}

void collect_nested(Entry& entry, std::vector<Entry>& parts) {
  for (Entry& child : entry.children)
    if (is_modbus_key(child.key))
      parts.push_back(std::move(child));
    else
      collect_nested(child, parts);
}

/// Blank lines in place of the blocks that are not kept, which need not be YAML that a map's loader reads.
std::string kept_text(const std::vector<Block>& blocks) {
  std::string kept;
  for (const Block& block : blocks)
    if (block.keep)
      kept += block.text;
    else
      kept.append(static_cast<std::size_t>(std::count(block.text.begin(), block.text.end(), '\n')), '\n');
  return kept;
}

/// Returns the places of "platform: modbus": the form of old versions, as `sensor: [{platform: modbus, …}]`.
std::vector<Position> old_forms(std::string_view text) {
  std::vector<Position> places;
  int number = 0;
  for (std::string_view rest = text; !rest.empty();) {
    const std::string_view line = first_line(rest);
    rest.remove_prefix(std::min(line.size() + 1, rest.size()));
    ++number;
    constexpr std::string_view word = "platform";
    const std::size_t key = line.find(word);
    if (key == std::string_view::npos || line.substr(0, key).find('#') != std::string_view::npos) continue;
    const std::size_t colon = line.find_first_not_of(blanks_and_quotes, key + word.size());
    if (colon == std::string_view::npos || line[colon] != ':') continue;
    const std::size_t begin = line.find_first_not_of(blanks_and_quotes, colon + 1);
    if (begin == std::string_view::npos) continue;
    const std::size_t end = std::min(line.find_first_of(" \t\r\"',}", begin), line.size());
    if (line.substr(begin, end - begin) == "modbus") places.push_back({number, static_cast<int>(key) + 1});
  }
  return places;
}

/// The tags of values, as `!secret` and `!include`, become plain text of the same length. Returns where they
/// were.
TagPlaces blank_tags(std::string& text) {
  TagPlaces places;
  int line = 1;
  std::size_t line_begins = 0;
  char quote = '\0';
  char before = '\n';  // the last character that is not a blank
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    const bool begins_value = std::string_view("\n:-,[{").find(before) != std::string_view::npos;
    if (c == '\n') {
      ++line;
      line_begins = i + 1;
      quote = '\0';
    } else if (quote != '\0') {
      if (c == quote) quote = '\0';
    } else if (c == '#' && i > line_begins && (text[i - 1] == ' ' || text[i - 1] == '\t')) {
      i = std::min(text.find('\n', i), text.size()) - 1;
      continue;
    } else if (c == '&' && begins_value) {  // an anchor: the value comes behind it
      i = std::min(text.find_first_of(" \t\r\n,]}", i), text.size()) - 1;
      continue;
    } else if ((c == '"' || c == '\'') && begins_value) {
      quote = c;
    } else if (c == '!' && begins_value) {
      places.emplace(line, static_cast<int>(i - line_begins) + 1);
      text[i] = '~';
    }
    if (c != ' ' && c != '\t' && c != '\r') before = c;
  }
  return places;
}

/// Says what becomes of a value with a tag. False if it is to be left out.
bool keep_tagged(Entry& entry, Problems& problems) {
  const std::string tag = '!' + entry.text.substr(1, entry.text.find(' ') - 1);
  const std::string where = entry.key.empty() ? "the value" : fmt::format("'{}'", entry.key);
  const bool is_address = entry.key == "address";
  if (tag == "!secret" && (is_address || entry.key == "slave" || entry.key == "device_address")) {
    if (is_address)
      problems.error(entry.at, "'address' is a secret, which is not read",
                     "write the number in the place of the tag");
    entry.kind = Entry::Kind::null;
    entry.text[0] = '!';
    return true;
  }
  if (tag == "!secret")
    problems.warning(entry.at, fmt::format("{} is a secret, which is not read, so it is left out", where),
                     "write it into the map, or in the place of the tag");
  else if (tag.substr(0, 8) == "!include")
    problems.error(entry.at, fmt::format("{} stands in another file", where),
                   "give that file, or put its text in the place of the tag");
  else
    problems.error(entry.at, fmt::format("the tag {} of {} is not known", shown(tag), where),
                   "write the value in its place");
  return false;
}

}  // namespace

void take_tags_out(Entry& entry, const TagPlaces& places, Problems& problems) {
  const auto is_left_out = [&](Entry& child) {
    return child.kind == Entry::Kind::scalar && places.count({child.at.line, child.at.column}) != 0 &&
           !keep_tagged(child, problems);
  };
  entry.children.erase(std::remove_if(entry.children.begin(), entry.children.end(), is_left_out),
                       entry.children.end());
  for (Entry& child : entry.children) take_tags_out(child, places, problems);
}

std::optional<HomeAssistantFile> read_home_assistant_file(std::string_view text, Problems& problems) {
  std::vector<Block> blocks = blocks_of(text);
  const Below below = place_of_hubs(blocks);
  if (below != Below::nothing) choose_blocks(blocks, below);
  if (below == Below::key) tell_packages(blocks, problems);
  std::string kept = below != Below::nothing ? kept_text(blocks) : std::string(text);
  HomeAssistantFile file;
  file.tags = blank_tags(kept);
  file.old_form = old_forms(text);
  auto root = loader::parse_document(kept, problems, loader::Aliases::read);
  if (!root) return std::nullopt;
  if (below == Below::packages) {
    collect_nested(*root, file.parts);
  } else if (below == Below::key) {
    for (Entry& part : root->children)
      if (is_modbus_key(part.key)) file.parts.push_back(std::move(part));
  } else {
    file.parts.push_back(std::move(*root));
  }
  return file;
}

std::string_view secret_of(const Entry& entry) {
  constexpr std::string_view tag = "!secret";
  const std::string_view text = entry.text;
  const bool is_secret = entry.kind == Entry::Kind::null && text.substr(0, tag.size()) == tag;
  return is_secret ? without_quotes(text.substr(tag.size())) : std::string_view{};
}

}  // namespace coupler::formats
