// SPDX-License-Identifier: Apache-2.0
#include "coupler/map/escape.hpp"

#include <fmt/format.h>

#include "coupler/map/printable.hpp"

namespace coupler {
namespace {

/// Calls use(bytes) with each character. Line breaks and other control characters, which would end a cell or
/// be dropped without a trace, are a blank. What turns the direction of writing shows as its number.
template <class Use>
void each_character(std::string_view text, const Use& use) {
  for (std::size_t at = 0; at < text.size();) {
    const Character c = character_at(text, at);
    if (turns_direction(c.code))
      use(fmt::format("U+{:04X}", static_cast<unsigned>(c.code)));
    else
      use(std::string(c.code < 0x20 || c.code == 0x7F ? " " : text.substr(at, c.size)));
    at += c.size;
  }
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
  each_character(text, [&](const std::string& c) {
    const std::string_view name = entity(c[0]);
    out += name.empty() ? std::string_view(c) : name;
  });
  return out;
}

std::string markdown(std::string_view text) {
  constexpr std::string_view punctuation = R"(\`*_[]|~$:)";
  std::string out;
  each_character(text, [&](const std::string& c) {
    if (c == "&" || c == "<" || c == ">") {
      out += entity(c[0]);
      return;
    }
    if (punctuation.find(c[0]) != std::string_view::npos) out += '\\';
    out += c;
  });
  return out;
}

std::string one_line(std::string_view text) {
  std::string out;
  each_character(text, [&](const std::string& c) { out += c; });
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

}  // namespace coupler
