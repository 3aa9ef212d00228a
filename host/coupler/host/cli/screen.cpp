// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/cli/screen.hpp"

#include <fmt/format.h>

namespace coupler::cli {

std::string frame(const std::vector<std::string>& lines, std::size_t rows) {
  const std::size_t room = rows > 2 ? rows - 1 : 1;  // below them the cursor has a row of its own
  const std::size_t shown = lines.size() <= room ? lines.size() : room - 1;
  std::string text = "\033[H";
  for (std::size_t i = 0; i < shown; ++i) text += lines[i] + "\033[K\n";
  if (shown < lines.size())
    text += fmt::format("… and {} lines more; choose points with --points\033[K\n", lines.size() - shown);
  return text + "\033[J";
}

}  // namespace coupler::cli
