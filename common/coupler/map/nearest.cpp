// SPDX-License-Identifier: Apache-2.0
#include "coupler/map/nearest.hpp"

#include <algorithm>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "coupler/base/lower.hpp"

namespace coupler {
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
  std::vector<std::string_view> best;
  unsigned least = static_cast<unsigned>(1 + word.size() / 4);
  for (const std::string_view candidate : candidates) {
    const unsigned distance = edit_distance(lower(word), lower(candidate));
    if (distance > least || distance >= candidate.size()) continue;
    if (distance < least) best.clear();
    least = distance;
    best.push_back(candidate);
  }
  return best;
}

bool is_slip(std::string_view word, std::string_view candidate) {
  constexpr std::size_t longest = 40;
  if (word.size() > longest) return false;
  const auto most = std::max<std::size_t>(1, word.size() / 4);
  const unsigned distance = edit_distance(lower(word), lower(candidate));
  return distance <= most && distance < std::min(word.size(), candidate.size());
}

std::string_view nearest(std::string_view word, const std::vector<std::string_view>& candidates) {
  const auto best = all_nearest(word, candidates);
  return best.empty() ? std::string_view{} : best.front();
}

std::string nearest_or(std::string_view word, const std::vector<std::string_view>& candidates,
                       std::string otherwise) {
  const std::string_view near = nearest(word, candidates);
  return near.empty() ? std::move(otherwise) : fmt::format("did you mean '{}'?", near);
}

std::string suggestion(std::string_view word, const std::vector<std::string_view>& candidates) {
  return nearest_or(word, candidates, fmt::format("write one of {}", fmt::join(candidates, ", ")));
}

}  // namespace coupler
