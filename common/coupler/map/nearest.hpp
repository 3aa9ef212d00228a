// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace coupler {

/// Insertions, deletions, replacements and swaps of neighbours that turn one word into the other.
unsigned edit_distance(std::string_view a, std::string_view b);

/// The words differ by no more than a slip of the fingers, whatever the case: by one letter, in long words by
/// one in four. A letter that is doubled or not counts only once. No word is a slip of its opposite: "no" of
/// "on", "unlatched" of "latched".
bool is_slip(std::string_view word, std::string_view candidate);

/// Returns the candidates that the word is a slip of, and of these only those that differ least.
std::vector<std::string_view> all_nearest(std::string_view word,
                                          const std::vector<std::string_view>& candidates);

/// The candidate that was most likely meant, whatever the case; empty if none is near, or if what is near
/// says opposite things ("on" and "off" for "of").
std::string_view nearest(std::string_view word, const std::vector<std::string_view>& candidates);

/// "did you mean 'x'?", or "write one of a, b, c" when nothing is near.
std::string suggestion(std::string_view word, const std::vector<std::string_view>& candidates);

/// "did you mean 'x'?", or `otherwise` when nothing is near.
std::string nearest_or(std::string_view word, const std::vector<std::string_view>& candidates,
                       std::string otherwise);

/// "`otherwise`, or update coupler (…)", for a word that may come from a newer version.
std::string or_update(std::string otherwise);

}  // namespace coupler
