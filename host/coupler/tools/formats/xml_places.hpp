// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <string_view>
#include <vector>

#include "coupler/map/loader/document.hpp"

namespace coupler::formats {

/// Lines and columns of what stands in an XML text, by binary search: there may be many.
class XmlPlaces {
 public:
  explicit XmlPlaces(std::string_view text) : text_(text) {
    for (std::size_t i = 0; i < text.size(); ++i)
      if (text[i] == '\n') starts_.push_back(i + 1);
  }

  loader::Position at(std::ptrdiff_t offset) const {
    const auto place = static_cast<std::size_t>(std::max<std::ptrdiff_t>(offset, 0));
    const auto after = std::upper_bound(starts_.begin(), starts_.end(), place);
    return {static_cast<int>(after - starts_.begin()), static_cast<int>(place - *(after - 1)) + 1};
  }

  /// The attribute of the tag that begins at `offset`; the tag itself if it has none of that name.
  loader::Position attribute(std::ptrdiff_t offset, std::string_view name) const {
    const std::string_view tag = text_.substr(static_cast<std::size_t>(std::max<std::ptrdiff_t>(offset, 0)));
    const std::size_t end = tag.find('>');
    std::size_t found = tag.find(name, 1);
    while (found < end && std::string_view(" \t\r\n").find(tag[found - 1]) == std::string_view::npos)
      found = tag.find(name, found + 1);
    return at(found < end ? offset + static_cast<std::ptrdiff_t>(found) : offset);
  }

 private:
  std::string_view text_;
  std::vector<std::size_t> starts_{0};
};

}  // namespace coupler::formats
