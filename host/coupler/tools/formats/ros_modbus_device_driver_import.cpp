// SPDX-License-Identifier: Apache-2.0
#include "coupler/tools/formats/importers.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "coupler/map/loader/document.hpp"
#include "coupler/map/loader/scalar.hpp"
#include "coupler/map/loader/source_text.hpp"
#include "coupler/tools/formats/map_tree.hpp"

namespace coupler::formats {
namespace {

using loader::Entry;
using loader::Problems;

/// The column at which a line of YAML has a comment, 0 if it has none. Quotes over several lines are not
/// followed, so text in them may be reported as a comment.
int comment_column(std::string_view line) {
  char quote = '\0';
  for (std::size_t i = 0; i < line.size(); ++i) {
    const char c = line[i];
    if (quote != '\0') {
      if (c == quote) quote = '\0';
    } else if (c == '"' || c == '\'') {
      quote = c;
    } else if (c == '#' && (i == 0 || line[i - 1] == ' ' || line[i - 1] == '\t')) {
      return static_cast<int>(i) + 1;
    }
  }
  return 0;
}

void warn_of_comment(int line, int column, Problems& problems) {
  problems.warning({line, column}, "the comment is not carried over",
                   "copy it by hand, or put it into the point's 'description'");
}

/// Once a line.
void warn_of_comments(std::string_view text, bool json, std::string_view blanked, Problems& problems) {
  for (int line = 1; !text.empty(); ++line) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    if (json) {
      const auto differs =
          std::mismatch(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(end), blanked.begin());
      const auto column = differs.first - text.begin();
      if (column < static_cast<std::ptrdiff_t>(end))
        warn_of_comment(line, static_cast<int>(column) + 1, problems);
      blanked.remove_prefix(std::min(end + 1, blanked.size()));
    } else if (const int column = comment_column(text.substr(0, end)); column > 0) {
      warn_of_comment(line, column, problems);
    }
    text.remove_prefix(std::min(end + 1, text.size()));
  }
}

}  // namespace

std::vector<ForeignUnit> read_ros_modbus_device_driver(std::string_view text,
                                                       const ImportOptions& /*options*/, Problems& problems) {
  auto root = loader::parse_document(text, problems);
  if (!root) return {};
  std::string blanked(text);
  Problems ignored("");  // parse_document() has reported them
  const bool json = loader::is_json(text);
  if (json && !loader::blank_comments(blanked, ignored)) return {};
  warn_of_comments(text, json, blanked, problems);
  ForeignUnit unit;
  const Entry* number = loader::child(*root, "unit");
  if (const auto value = number != nullptr ? loader::parse_unsigned(number->text) : std::nullopt;
      value && *value < 256)
    unit.unit = static_cast<unsigned>(*value);
  unit.map = std::move(*root);
  std::vector<ForeignUnit> units;
  units.push_back(std::move(unit));
  return units;
}

}  // namespace coupler::formats
