// SPDX-License-Identifier: Apache-2.0
// The names of a map among the macros of C++ headers: a point may be called BUFSIZ, and nobody knows which
// headers stand before the generated ones.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "coupler/base/span.hpp"

namespace coupler::generate {

/// Macros of the C and POSIX headers that are written as other names are and stand for something without
/// parentheses behind them. No point's member has one of these names (members()).
Span<const std::string_view> small_macros();

/// A header may have a macro of that name that needs no parentheses: it is one of small_macros(), it has a
/// capital letter that no small one follows, or POSIX leaves its prefix to the headers.
bool could_be_macro(std::string_view name);

/// Lines around code that uses names.
struct WithoutMacros {
  std::string before;
  std::string after;
};

/// Between the two, those of the names that could be macros are none. Empty if there is no such name.
WithoutMacros without_macros(std::vector<std::string> names);

}  // namespace coupler::generate
