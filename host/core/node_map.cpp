// SPDX-License-Identifier: Apache-2.0
#include "host/core/node_map.hpp"

#include <array>

#include <fmt/format.h>

#include "common/map/crc32.hpp"
#include "common/modbus/bytes.hpp"

namespace coupler::driver {
namespace {

/// No map is as large; a device that says so is not to be believed.
constexpr std::uint32_t largest_map = 16U << 20U;

Result<std::optional<ServedMap>> fetch_both(Transport& transport) {
  if (auto connected = transport.connect(); !connected) return tl::make_unexpected(connected.error());
  const auto head = read_identity(transport);
  if (!head) return tl::make_unexpected(head.error());
  if (!head->has_value()) return std::nullopt;
  auto text = fetch_map_text(transport, (*head)->map_size);
  if (!text) return tl::make_unexpected(text.error());
  return ServedMap{**head, std::move(*text)};
}

}  // namespace

Result<std::optional<identity::Head>> read_identity(Transport& transport) {
  std::array<std::uint16_t, identity::head_size> area{};
  const auto range = modbus::Range::of(identity::reserved.start(), identity::head_size);
  if (auto read = transport.read_registers(Table::input_registers, range, area.data()); !read) {
    if (exception_in(read.error()) != nullptr && !is_unit_away(read.error())) return std::nullopt;
    return tl::make_unexpected(read.error());
  }
  return identity::read_head(area);
}

Result<std::string> fetch_map_text(Transport& transport, std::uint32_t size) {
  if (size > largest_map) return fail(BadFrame{fmt::format("a map of {} bytes", size)});
  std::string text;
  text.reserve(size + 1);
  std::array<std::uint16_t, modbus::max_file_registers> registers{};
  while (text.size() < size) {
    const auto at = identity::record_at(static_cast<std::uint32_t>(text.size() / 2), size);
    const Span<std::uint16_t> piece(registers.data(), at.registers);
    if (auto read = transport.read_file_record(at.file, at.record, piece); !read)
      return tl::make_unexpected(read.error());
    for (const std::uint16_t word : piece) {
      std::array<std::uint8_t, 2> bytes{};
      modbus::put_u16(bytes.data(), word);
      text.append(bytes.begin(), bytes.end());
    }
  }
  text.resize(size);
  return text;
}

Result<std::optional<ServedMap>> fetch_served_map(Transport& transport) {
  auto served = fetch_both(transport);
  transport.close();
  return served;
}

tl::expected<MapPtr, std::string> load_node_map(const std::string& text, const identity::Head& head,
                                                const MapLoader& load) {
  if (crc32(text) != head.map_crc)
    return tl::make_unexpected(
        fmt::format("checksum {:08x} instead of {:08x}; restart the node", crc32(text), head.map_crc));
  LoadResult result = load(text, "the node's map");
  if (result.map) return result.map;
  std::string why = "it does not load";
  for (const Diagnostic& diagnostic : result.diagnostics) why += "\n" + to_string(diagnostic);
  return tl::make_unexpected(why);
}

}  // namespace coupler::driver
