// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/core/node_map.hpp"

#include <algorithm>
#include <array>

#include <fmt/format.h>

#include "coupler/base/version.hpp"
#include "coupler/map/fingerprint.hpp"
#include "coupler/modbus/pdu.hpp"

namespace coupler::host {
namespace {

/// False: the device refuses them, as a foreign coupler does and a node that is older than the fields.
Result<bool> read_if_mapped(Link& link, std::uint32_t first, Span<std::uint16_t> registers) {
  const auto range =
      modbus::Range::of(identity::reserved.start() + first, static_cast<std::uint32_t>(registers.size()));
  return link.read_if_mapped(Table::input_registers, range, registers.data());
}

/// The first registers of the area, as `parse` understands them.
template <class Area, class Parse>
auto read_area(Link& link, Parse parse) -> Result<decltype(parse(Area{}))> {
  Area area{};
  const auto given = read_if_mapped(link, 0, area);
  if (!given) return tl::make_unexpected(given.error());
  if (!*given) return std::nullopt;
  return parse(area);
}

Result<std::optional<ServedMap>> fetch_both(Link& link) {
  if (auto connected = link.connect(); !connected) return tl::make_unexpected(connected.error());
  const auto head = read_identity(link);
  if (!head) return tl::make_unexpected(head.error());
  if (!head->has_value()) return std::nullopt;
  auto text = fetch_map_text(link, (*head)->map_size);
  if (!text) return tl::make_unexpected(text.error());
  return ServedMap{**head, std::move(*text)};
}

}  // namespace

Result<std::optional<identity::Head>> read_identity(Link& link) {
  return read_area<std::array<std::uint16_t, identity::head_size>>(link, identity::read_head);
}

Result<std::optional<identity::Report>> read_report(Link& link) {
  auto report = read_area<std::array<std::uint16_t, identity::report_size>>(link, identity::read_report);
  if (!report || *report) return report;
  return read_area<std::array<std::uint16_t, identity::head_size>>(link, identity::read_report_head);
}

Result<identity::Further> read_further(Link& link) {
  std::uint16_t count = 0;
  const auto counted = read_if_mapped(link, identity::at_further, Span<std::uint16_t>(&count, 1));
  if (!counted) return tl::make_unexpected(counted.error());
  std::array<std::uint16_t, identity::further_size> area{};
  const Span<std::uint16_t> known(area.data(), std::min<std::size_t>(count, area.size()));
  if (!*counted || known.empty()) return identity::Further{};
  const auto given = read_if_mapped(link, identity::at_serial, known);
  if (!given) return tl::make_unexpected(given.error());
  if (!*given) return identity::Further{};
  identity::Further further = identity::read_further(known);
  for (char& c : further.machine.hostname)
    if (c != '\0' && (c < ' ' || c > '~')) c = '?';
  return further;
}

std::string to_string(const identity::Machine& machine) {
  std::string text(hostname_of(machine));
  if (machine.serial == 0) return text;
  return fmt::format("{}{}serial {:016x}", text, text.empty() ? "" : ", ", machine.serial);
}

Result<std::string> fetch_map_text(Link& link, std::uint32_t size) {
  if (size > max_file_size)
    return fail(BadFrame{fmt::format("a map of {} bytes; at most {} are possible", size, max_file_size)});
  std::string text;
  text.reserve(size + 1);
  std::array<std::uint16_t, modbus::max_file_registers> registers{};
  while (text.size() < size) {
    const auto at = identity::record_at(static_cast<std::uint32_t>(text.size() / 2), size);
    const Span<std::uint16_t> piece(registers.data(), at.registers);
    if (auto read = link.read_file_record(at.file, at.record, piece); !read)
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

Result<std::optional<ServedMap>> fetch_served_map(Link& link) {
  auto served = fetch_both(link);
  link.close();
  return served;
}

tl::expected<MapPtr, std::string> load_node_map(const std::string& text, const identity::Head& head,
                                                const MapLoader& load) {
  if (crc32(text) != head.map_crc)
    return tl::make_unexpected(
        fmt::format("checksum {:08x} instead of {:08x}; restart the device", crc32(text), head.map_crc));
  LoadResult result = load(text, "the device's map");
  if (result.map) return result.map;
  std::string why =
      fmt::format("it does not load in coupler {}; if the node has a newer one, update this one", version);
  for (const Diagnostic& diagnostic : shortened(std::move(result.diagnostics)))
    why += "\n" + to_string(diagnostic);
  return tl::make_unexpected(why);
}

}  // namespace coupler::host
