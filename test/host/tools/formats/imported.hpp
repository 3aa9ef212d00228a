// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include "coupler/tools/formats/importers.hpp"

namespace coupler::test {

std::string lines_of(const Diagnostics& diagnostics);

/// What an importer makes of a text, and what the loader then makes of what it wrote.
struct Imported {
  Imported(std::string_view format, std::string_view text, const formats::ImportOptions& options = {});
  ~Imported();

  /// The written file, without its first line, which says where it comes from.
  std::string text(std::size_t i = 0) const;

  formats::ImportResult result;
  std::string said;
};

}  // namespace coupler::test
