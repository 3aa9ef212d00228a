// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace coupler {

/// Insertions, deletions, replacements and swaps of neighbours that turn one word into the other.
unsigned edit_distance(std::string_view a, std::string_view b);

/// The candidates that were most likely meant, whatever the case: those that differ least, if that is little.
/// One that says the opposite is never among them: "on" for "no", "latched" for "unlatched".
std::vector<std::string_view> all_nearest(std::string_view word,
                                          const std::vector<std::string_view>& candidates);

/// The words differ by no more than a slip of the fingers: by one letter, in long words by two or more.
bool is_slip(std::string_view word, std::string_view candidate);

/// The candidate that was most likely meant, whatever the case; empty if none is near, or if what is near
/// says opposite things ("on" and "off" for "of").
std::string_view nearest(std::string_view word, const std::vector<std::string_view>& candidates);

/// "did you mean 'x'?", or "write one of a, b, c" when nothing is near.
std::string suggestion(std::string_view word, const std::vector<std::string_view>& candidates);

/// "did you mean 'x'?", or `otherwise` when nothing is near.
std::string nearest_or(std::string_view word, const std::vector<std::string_view>& candidates,
                       std::string otherwise);

}  // namespace coupler
