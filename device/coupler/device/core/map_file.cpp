// SPDX-License-Identifier: Apache-2.0
#include "coupler/device/core/map_file.hpp"

#include <algorithm>
#include <cstring>

#include "coupler/modbus/limits.hpp"

namespace coupler::device {

bool read_map_file(std::string_view text, modbus::FileRecord wanted, Span<std::uint8_t> bytes) {
  const std::size_t first = (wanted.file - std::size_t{1}) * modbus::records_per_file + wanted.record;
  const std::size_t total = (text.size() + 1) / 2;
  if (first >= total || wanted.registers > total - first) return false;

  const std::size_t there = std::min(bytes.size(), text.size() - 2 * first);
  std::memcpy(bytes.data(), text.data() + 2 * first, there);
  std::fill(bytes.begin() + there, bytes.end(), std::uint8_t{0});
  return true;
}

}  // namespace coupler::device
