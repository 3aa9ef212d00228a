// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <charconv>
#include <optional>

#include <fmt/format.h>

#include "coupler/map/lock/lock.hpp"
#include "coupler/map/printable.hpp"

namespace coupler::lock {
namespace {

constexpr std::string_view blanks = " \t\r";

struct Word {
  std::string_view text;
  int column;
};

std::vector<Word> words_of(std::string_view line) {
  std::vector<Word> words;
  for (std::size_t at = line.find_first_not_of(blanks); at != std::string_view::npos;) {
    const std::size_t end = std::min(line.find_first_of(blanks, at), line.size());
    words.push_back({line.substr(at, end - at), static_cast<int>(at + 1)});
    at = line.find_first_not_of(blanks, end);
  }
  return words;
}

bool is_conflict_marker(std::string_view line) {
  const std::string_view start = line.substr(0, 7);
  return start == "<<<<<<<" || start == "|||||||" || start == "=======" || start == ">>>>>>>";
}

/// The word as a message shows it: names are short, other things need not be.
std::string shown(std::string_view word) {
  const std::string text = printable(word.substr(0, 40));
  return fmt::format("'{}{}'", text, word.size() > 40 ? "..." : "");
}

std::optional<Table> table_of(std::string_view word) {
  for (const Table table : tables)
    if (word == to_string(table)) return table;
  return std::nullopt;
}

std::optional<std::uint32_t> number_of(std::string_view word) {
  std::uint32_t value = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (error != std::errc() || end != word.data() + word.size() || value > 0xFFFF) return std::nullopt;
  return value;
}

std::optional<std::uint16_t> mask_of(std::string_view part) {
  if (part == "high") return high_half;
  if (part == "low") return low_half;
  const auto bit = number_of(part);
  if (!bit || *bit > 15) return std::nullopt;
  return static_cast<std::uint16_t>(1U << *bit);
}

std::optional<Place> place_of(Table table, std::string_view word) {
  const std::size_t mark = word.find_first_of("-.");
  const auto first = number_of(word.substr(0, mark));
  if (!first) return std::nullopt;
  if (mark == std::string_view::npos) return Place{table, modbus::Range::of(*first, 1)};
  const std::string_view rest = word.substr(mark + 1);
  if (word[mark] == '-') {
    const auto last = number_of(rest);
    if (!last || *last < *first) return std::nullopt;
    return Place{table, modbus::Range::of(*first, *last - *first + 1)};
  }
  const auto mask = mask_of(rest);
  if (!mask || holds_bits(table)) return std::nullopt;
  return Place{table, modbus::Range::of(*first, 1), *mask};
}

class Parser {
 public:
  explicit Parser(std::string_view file) : file_(file) {}

  Parsed run(std::string_view text) {
    for (std::size_t at = 0; at < text.size();) {
      const std::size_t end = std::min(text.find('\n', at), text.size());
      ++line_;
      read_line(text.substr(at, end - at));
      at = end + 1;
    }
    if (!begun_ && problems_.empty()) no_lock(std::max(line_, 1), 1);
    check_places();
    check_names();
    if (!problems_.empty()) lock_.clear();
    std::stable_sort(problems_.begin(), problems_.end(),
                     [](const Diagnostic& a, const Diagnostic& b) { return a.line < b.line; });
    return {std::move(lock_), std::move(problems_)};
  }

 private:
  void error(int line, int column, std::string what, std::string remedy) {
    problems_.push_back(
        {Diagnostic::Severity::error, file_, line, column, std::move(what), std::move(remedy)});
  }
  void note(int line, std::string what) { problems_.back().notes.push_back({line, 1, std::move(what)}); }

  void no_lock(int line, int column) {
    error(line, column, fmt::format("a lock begins with '{}'", first_line),
          "restore the file from version control");
    begun_ = true;
  }

  void read_line(std::string_view line) {
    if (is_conflict_marker(line))
      return error(line_, 1, fmt::format("{} is the marker of a merge conflict", shown(line.substr(0, 7))),
                   "delete the markers and keep the lines of both sides; of two that give one place away, "
                   "delete that of the younger point");
    const std::vector<Word> words = words_of(line);
    if (words.empty() || words[0].text[0] == '#') return;
    if (begun_) return read_entry(words);
    const bool good = words.size() == 3 && words[0].text == "coupler" && words[1].text == "lock";
    if (!good) return no_lock(line_, words[0].column);
    begun_ = true;
    if (words[2].text != "1")
      error(
          line_, words[2].column,
          fmt::format("the lock has version {}, but this program knows only version 1", shown(words[2].text)),
          "use a newer coupler");
  }

  void read_entry(const std::vector<Word>& words) {
    constexpr auto example =
        "write it as in 'holding_registers 5-8 total', or restore the file from version control";
    if (words.size() < 3)
      return error(line_, words[0].column, "a line of a lock is TABLE PLACE NAME", example);
    const auto table = table_of(words[0].text);
    if (!table)
      return error(line_, words[0].column, fmt::format("{} is not a table", shown(words[0].text)),
                   "write coils, discrete_inputs, input_registers or holding_registers");
    const auto place = place_of(*table, words[1].text);
    if (!place)
      return error(line_, words[1].column,
                   fmt::format("{} is not a place in {}", shown(words[1].text), to_string(*table)),
                   holds_bits(*table) ? "write 5, or 5-8 for an array"
                                      : "write 5, 5-8, 5.high, 5.low, or 5.3 for bit 3");
    const bool retired = words.size() == 4 && words[3].text == "retired";
    if (words.size() > 3 && !retired)
      return error(line_, words[3].column,
                   fmt::format("{} after the name; only 'retired' may stand there", shown(words[3].text)),
                   example);
    lock_.push_back({*place, std::string(words[2].text), retired, line_});
  }

  void check_places() {
    std::stable_sort(lock_.begin(), lock_.end(),
                     [](const Entry& a, const Entry& b) { return less(a.place, b.place); });
    Occupancy taken;
    for (auto entry = lock_.begin(); entry != lock_.end(); ++entry) {
      if (taken.is_free(entry->place)) {
        taken.take(entry->place);
        continue;
      }
      const auto other = std::find_if(
          lock_.begin(), entry, [&](const Entry& before) { return overlap(before.place, entry->place); });
      const auto [first, second] =
          std::minmax(*other, *entry, [](const Entry& a, const Entry& b) { return a.line < b.line; });
      error(second.line, 1,
            fmt::format("{} of {} overlaps {} of {} (line {})", to_string(second.place), shown(second.name),
                        to_string(first.place), shown(first.name), first.line),
            "delete the line of the younger point; `coupler check MAP` then gives it another address");
      note(first.line, "the other is here");
    }
  }

  void check_names() {
    const Names names(lock_);
    for (const Entry& entry : lock_) {
      const Entry& first = *names.find(entry.place.table, entry.name);
      if (&first == &entry) continue;
      const auto [above, below] = std::minmax(first.line, entry.line);
      error(below, 1,
            fmt::format("{} is in {} twice, in lines {} and {}", shown(entry.name),
                        to_string(entry.place.table), above, below),
            "delete one of the two lines");
      note(above, "the other is here");
    }
  }

  std::string file_;
  int line_ = 0;
  bool begun_ = false;
  Lock lock_;
  Diagnostics problems_;
};

}  // namespace

Parsed parse(std::string_view text, std::string_view file) { return Parser(file).run(text); }

}  // namespace coupler::lock
