// SPDX-License-Identifier: Apache-2.0
#include "coupler/schema/pattern.hpp"

#include "coupler/map/loader/scalar.hpp"

namespace coupler::schema {

std::string any_case(const std::vector<std::string_view>& words) {
  std::string pattern;
  for (const std::string_view word : words) {
    pattern += pattern.empty() ? "^(" : "|";
    for (const char c : word) {
      if (c == '-')
        pattern += "[-_]?";
      else if (loader::is_letter(c))
        pattern += {'[', c, static_cast<char>(c ^ ' '), ']'};  // both cases
      else
        pattern += c;
    }
  }
  return pattern + ")$";
}

}  // namespace coupler::schema
