// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/modbus/bad_reply.hpp"

#include <algorithm>

#include <fmt/format.h>

namespace coupler::host {

std::string shown_bytes(modbus::Bytes bytes) {
  constexpr std::size_t most = 16;
  std::string text;
  for (std::size_t i = 0; i < std::min(bytes.size(), most); ++i)
    text += fmt::format("{}{:02x}", i > 0 ? " " : "", bytes[i]);
  return bytes.size() > most ? fmt::format("{} … ({} bytes)", text, bytes.size()) : text;
}

BadFrame bad_reply(std::string_view what, modbus::Bytes asked, modbus::Bytes came) {
  return {fmt::format("{}; asked {}, got {}", what, shown_bytes(asked), shown_bytes(came))};
}

}  // namespace coupler::host
