// SPDX-License-Identifier: Apache-2.0
#include "coupler/map/nearest.hpp"

#include <algorithm>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "coupler/base/lower.hpp"
#include "coupler/base/version.hpp"

namespace coupler {
namespace {

/// Words on the left say the opposite of those on the right.
constexpr std::pair<std::string_view, std::string_view> opposite_words[] = {
    {" on yes true always enable enabled allow allowed active with ",
     " off no not non none false never disable disabled deny denied inactive without "},
    {" high hi upper ", " low lo lower "},
    {" up ", " down dn "},
    {" open opened ", " close closed "},
    {" rising ", " falling "},
    {" start ", " stop "},
    {" min ", " max "},
};

/// Some word of the name, as "active" in "active_low", is one of the list.
bool has_word_of(std::string_view list, std::string_view name) {
  constexpr std::string_view separators = " _-./";
  for (std::size_t begin = 0; begin < name.size();) {
    const std::size_t end = std::min(name.find_first_of(separators, begin), name.size());
    const std::string padded = fmt::format(" {} ", name.substr(begin, end - begin));
    if (end > begin && list.find(padded) != std::string_view::npos) return true;
    begin = end + 1;
  }
  return false;
}

/// "unlatched" is the opposite of "latched", but "inital" is none of "initial".
bool negates(std::string_view word, std::string_view other) {
  constexpr std::string_view prefixes[] = {"non", "not", "no", "un", "in", "dis"};
  for (const std::string_view prefix : prefixes) {
    if (word.substr(0, prefix.size()) != prefix) continue;
    const std::size_t rest = word.find_first_not_of("_- ", prefix.size());
    if (rest == std::string_view::npos || word.size() - rest < 3) continue;
    if (edit_distance(word.substr(rest), other) < edit_distance(word, other)) return true;
  }
  return false;
}

/// Nobody who wrote the one is told to write the other: "no" and "on", "enabled" and "disabled". In lower
/// case.
bool are_opposites(std::string_view a, std::string_view b) {
  for (const auto& [left, right] : opposite_words) {
    const bool a_left = has_word_of(left, a), a_right = has_word_of(right, a);
    const bool b_left = has_word_of(left, b), b_right = has_word_of(right, b);
    if (a_left != a_right && b_left != b_right && a_left == b_right) return true;
  }
  return negates(a, b) || negates(b, a);
}

/// "adres" is no further from "address" than "adress" is.
std::string without_doubled_letters(std::string word) {
  word.erase(
      std::unique(word.begin(), word.end(), [](char a, char b) { return a == b && a >= 'a' && a <= 'z'; }),
      word.end());
  return word;
}

}  // namespace

unsigned edit_distance(std::string_view a, std::string_view b) {
  const std::size_t width = b.size() + 1;
  std::vector<unsigned> before(width);
  std::vector<unsigned> last(width);
  std::vector<unsigned> row(width);
  for (std::size_t j = 0; j < width; ++j) row[j] = static_cast<unsigned>(j);
  for (std::size_t i = 1; i <= a.size(); ++i) {
    before.swap(last);
    last.swap(row);
    row[0] = static_cast<unsigned>(i);
    for (std::size_t j = 1; j < width; ++j) {
      const unsigned replaced = last[j - 1] + (a[i - 1] == b[j - 1] ? 0U : 1U);
      row[j] = std::min({last[j] + 1, row[j - 1] + 1, replaced});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
        row[j] = std::min(row[j], before[j - 2] + 1);
    }
  }
  return row[b.size()];
}

std::vector<std::string_view> all_nearest(std::string_view word,
                                          const std::vector<std::string_view>& candidates) {
  constexpr std::size_t longest = 40;  // longer words are no typing mistakes, and would cost time
  if (word.size() > longest) return {};
  const std::string given = lower(word);
  std::vector<std::string_view> best;
  unsigned least = std::max(1U, static_cast<unsigned>(word.size() / 4));
  for (const std::string_view candidate : candidates) {
    if (candidate.size() > word.size() + least + 1) continue;
    const std::string known = lower(candidate);
    const unsigned distance =
        std::min(edit_distance(given, known),
                 1 + edit_distance(without_doubled_letters(given), without_doubled_letters(known)));
    if (distance > least || distance >= std::min(word.size(), candidate.size()) ||
        are_opposites(given, known))
      continue;
    if (distance < least) best.clear();
    least = distance;
    best.push_back(candidate);
  }
  return best;
}

bool is_slip(std::string_view word, std::string_view candidate) {
  return !all_nearest(word, {candidate}).empty();
}

std::string_view nearest(std::string_view word, const std::vector<std::string_view>& candidates) {
  const auto best = all_nearest(word, candidates);
  if (best.empty()) return {};
  const bool open = std::any_of(best.begin(), best.end(), [&](std::string_view other) {
    return are_opposites(lower(best.front()), lower(other));
  });
  return open ? std::string_view{} : best.front();
}

std::string nearest_or(std::string_view word, const std::vector<std::string_view>& candidates,
                       std::string otherwise) {
  const std::string_view near = nearest(word, candidates);
  return near.empty() ? std::move(otherwise) : fmt::format("did you mean '{}'?", near);
}

std::string suggestion(std::string_view word, const std::vector<std::string_view>& candidates) {
  return nearest_or(word, candidates, fmt::format("write one of {}", fmt::join(candidates, ", ")));
}

std::string or_update(std::string otherwise) {
  return fmt::format("{}, or update coupler (this is {}, and a newer one may know it)", std::move(otherwise),
                     version);
}

}  // namespace coupler
