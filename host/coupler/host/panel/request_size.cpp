// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/panel/request_size.hpp"

#include <algorithm>
#include <charconv>
#include <system_error>

#include "coupler/base/lower.hpp"

namespace coupler::host {
namespace {

constexpr std::string_view end_of_line = "\r\n";
constexpr std::string_view end_of_header = "\r\n\r\n";
constexpr std::string_view content_length = "content-length:";

/// 0 without such a line; a number that is none is the server's to refuse.
std::size_t announced_length(std::string_view header) {
  for (std::size_t line = header.find(end_of_line); line != std::string_view::npos;
       line = header.find(end_of_line, line + 1)) {
    std::string_view rest = header.substr(line + end_of_line.size());
    if (lower(rest.substr(0, content_length.size())) != content_length) continue;
    rest.remove_prefix(content_length.size());
    while (!rest.empty() && (rest.front() == ' ' || rest.front() == '\t')) rest.remove_prefix(1);
    std::size_t length = 0;
    const auto read = std::from_chars(rest.data(), rest.data() + rest.size(), length);
    return read.ec == std::errc::result_out_of_range ? std::string_view::npos : length;
  }
  return 0;
}

}  // namespace

std::size_t request_size(std::string_view text, std::size_t from, std::size_t largest) {
  const std::size_t end = text.find(end_of_header, from - std::min(from, end_of_header.size() - 1));
  if (end == std::string_view::npos) return unknown_size;
  const std::size_t length = announced_length(text.substr(0, end));
  return end + end_of_header.size() + (length <= largest ? length : 0);
}

}  // namespace coupler::host
