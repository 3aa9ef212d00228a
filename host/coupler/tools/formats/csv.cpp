// SPDX-License-Identifier: Apache-2.0
#include "coupler/tools/formats/csv.hpp"

#include <algorithm>
#include <array>

#include <fmt/format.h>

#include "coupler/base/csv_cell.hpp"
#include "coupler/tools/formats/csv_scan.hpp"

namespace coupler::formats {
namespace {

constexpr std::string_view blanks = " \t";

class CsvParser {
 public:
  CsvParser(std::string_view text, loader::Problems& problems)
      : text_(text), separator_(separator_of(text)), problems_(problems) {}

  std::vector<Row> run() {
    while (at_ < text_.size())
      if (!read_row()) return {};
    return std::move(rows_);
  }

 private:
  bool ends_cell() const { return at_ == text_.size() || text_[at_] == separator_ || ends_line(); }
  bool ends_line() const {
    return at_ < text_.size() &&
           (text_[at_] == '\n' || (text_[at_] == '\r' && at_ + 1 < text_.size() && text_[at_ + 1] == '\n'));
  }
  loader::Position here() const { return {line_, static_cast<int>(at_ - line_start_) + 1}; }

  bool read_row() {
    Row row;
    for (;;) {
      if (!read_cell(row)) return false;
      if (at_ < text_.size() && text_[at_] == separator_)
        ++at_;
      else
        break;
    }
    end_line();
    if (std::any_of(row.begin(), row.end(), [](const Cell& cell) { return !cell.text.empty(); }))
      rows_.push_back(std::move(row));
    return true;
  }

  void end_line() {
    if (at_ == text_.size()) return;
    at_ += text_[at_] == '\r' ? 2 : 1;
    ++line_;
    line_start_ = at_;
  }

  bool read_cell(Row& row) {
    while (at_ < text_.size() && text_[at_] != separator_ &&
           blanks.find(text_[at_]) != std::string_view::npos)
      ++at_;
    Cell cell;
    cell.at = here();
    if (at_ < text_.size() && text_[at_] == '"') {
      if (!read_quoted(cell)) return false;
    } else {
      const std::size_t begin = at_;
      while (!ends_cell()) ++at_;
      cell.text = without_blanks(text_.substr(begin, at_ - begin));
    }
    row.push_back(std::move(cell));
    return true;
  }

  /// From the opening quote to what ends the cell.
  bool read_quoted(Cell& cell) {
    for (++at_; at_ < text_.size(); ++at_) {
      const char c = text_[at_];
      if (c == '"' && (at_ + 1 == text_.size() || text_[at_ + 1] != '"')) break;
      if (c == '"') ++at_;
      cell.text += c;
      if (c == '\n') {
        ++line_;
        line_start_ = at_ + 1;
      }
    }
    if (at_ == text_.size()) {
      problems_.error(cell.at, "the quote is never closed", "close it where the cell ends");
      return false;
    }
    ++at_;
    while (!ends_cell() && blanks.find(text_[at_]) != std::string_view::npos) ++at_;
    if (ends_cell()) return true;
    problems_.error(here(), "there is text after the closing quote", "inside quotes, write a quote twice");
    return false;
  }

  std::string_view text_;
  char separator_;
  loader::Problems& problems_;
  std::size_t at_ = 0;
  int line_ = 1;
  std::size_t line_start_ = 0;
  std::vector<Row> rows_;
};

}  // namespace

char separator_of(std::string_view text) {
  constexpr std::array separators{';', ',', '\t'};
  std::array<std::size_t, separators.size()> counts{};
  bool quoted = false;
  for (const char c : text) {
    if (c == '"') quoted = !quoted;
    if (quoted) continue;
    const auto* found = std::find(separators.begin(), separators.end(), c);
    if (found != separators.end()) ++counts[static_cast<std::size_t>(found - separators.begin())];
    if (c == '\n' && *std::max_element(counts.begin(), counts.end()) > 0) break;
  }
  return separators[static_cast<std::size_t>(std::max_element(counts.begin(), counts.end()) -
                                             counts.begin())];
}

std::string_view text_at(const Row& row, std::size_t column) {
  return column < row.size() ? std::string_view(row[column].text) : std::string_view{};
}

std::vector<Row> parse_csv(std::string_view text, loader::Problems& problems) {
  return CsvParser(text, problems).run();
}

bool is_text(const loader::Key& key, bool is_string) {
  return (key.kind == loader::ValueKind::text && key.inside == loader::Section::none) ||
         (key.kind == loader::ValueKind::value && is_string);
}

std::string guarded(std::string_view text) {
  return would_be_run(text) ? fmt::format("'{}", text) : std::string(text);
}

std::string_view unguarded(std::string_view text) {
  return text.substr(0, 1) == "'" && would_be_run(text) ? text.substr(1) : text;
}

}  // namespace coupler::formats
