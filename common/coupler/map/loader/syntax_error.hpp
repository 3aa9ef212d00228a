// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include "coupler/map/loader/document.hpp"

namespace coupler::loader {

/// Why a text is no document. Thrown through yaml-cpp, which knows no other way to stop; parse_document()
/// catches it.
struct SyntaxError {
  Position at;
  std::string what;
  std::string remedy;
};

/// yaml-cpp's `message` about `offset` of `text`, in words that help.
SyntaxError explain(std::string_view text, std::size_t offset, std::string_view message);

}  // namespace coupler::loader
