// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include "coupler/map/loader/keys.hpp"

namespace coupler::loader {

/// A word of other programs and manuals for what a key says here.
struct Synonym {
  std::string_view word;  ///< in lower case, without blanks, '-' and '_'
  std::string_view remedy;
  Section sections;       ///< where it is one
  bool harmless = false;  ///< without it every value is read the same
};

/// nullptr if the word is none in that section.
const Synonym* find_synonym(std::string_view word, Section section);

/// Returns what to write instead of a word that is none of the key's choices; empty if that is not known.
std::string_view remedy_for_choice(std::string_view word, std::string_view key);

}  // namespace coupler::loader
