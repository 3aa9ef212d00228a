// SPDX-License-Identifier: Apache-2.0
#include "coupler/docs/escape.hpp"

#include <algorithm>

#include <fmt/format.h>

namespace coupler::docs {
namespace {

/// Line breaks and other control characters would end a cell, or be dropped without a trace.
char printable(char c) {
  const auto byte = static_cast<unsigned char>(c);
  return byte < 0x20 || byte == 0x7F ? ' ' : c;
}

std::string_view entity(char c) {
  switch (c) {
    case '&': return "&amp;";
    case '<': return "&lt;";
    case '>': return "&gt;";
    case '"': return "&quot;";
    case '\'': return "&#39;";
    default: return {};
  }
}

}  // namespace

std::string html(std::string_view text) {
  std::string out;
  for (const char c : text) {
    const std::string_view name = entity(c);
    if (name.empty())
      out += printable(c);
    else
      out += name;
  }
  return out;
}

std::string markdown(std::string_view text) {
  constexpr std::string_view punctuation = R"(\`*_[]|~$:)";
  std::string out;
  for (const char c : text) {
    if (c == '&' || c == '<' || c == '>') {
      out += entity(c);
      continue;
    }
    if (punctuation.find(c) != std::string_view::npos) out += '\\';
    out += printable(c);
  }
  return out;
}

std::string one_line(std::string_view text) {
  std::string out(text);
  std::transform(out.begin(), out.end(), out.begin(), printable);
  return out;
}

std::string url_path(std::string_view path) {
  constexpr std::string_view kept = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789-._~/";
  std::string out;
  for (const char c : path) {
    if (kept.find(c) != std::string_view::npos)
      out += c;
    else
      out += fmt::format("%{:02X}", static_cast<unsigned>(static_cast<unsigned char>(c)));
  }
  return out;
}

}  // namespace coupler::docs
