// SPDX-License-Identifier: Apache-2.0
#include "coupler/map/identity.hpp"

#include <algorithm>
#include <tuple>

#include "coupler/codec/number.hpp"

namespace coupler::identity {

using codec::Order;

namespace {

constexpr bool are_in_the_report() {
  for (const Counter& counter : counters)
    if (counter.at < at_statistics || counter.at + 2 > report_size) return false;
  return true;
}
static_assert(are_in_the_report(),
              "A counter behind the report is a further field: nodes that do not have it are out there");
static_assert(sizeof(Counts) == counters.size() * sizeof(std::uint32_t), "each count has a row");

constexpr std::size_t hostname_registers = std::tuple_size_v<decltype(Machine::hostname)> / 2;
static_assert(at_hostname + hostname_registers <= at_functions);

}  // namespace

Head head_of(const Map& map) {
  return {map.fingerprint, static_cast<std::uint32_t>(map.text.size()), map.text_crc};
}

void write_head(const Head& head, std::uint16_t* area) {
  codec::encode(magic, Order::ABCD, area + at_magic);
  area[at_layout] = layout;
  codec::encode(head.fingerprint, Order::ABCD, area + at_fingerprint);
  codec::encode(head.map_size, Order::ABCD, area + at_map_size);
  codec::encode(head.map_crc, Order::ABCD, area + at_map_crc);
}

std::optional<Head> read_head(const std::array<std::uint16_t, head_size>& area) {
  const std::uint16_t* at = area.data();
  if (codec::decode<std::uint32_t>(at + at_magic, Order::ABCD) != magic || at[at_layout] != layout) return {};
  return Head{codec::decode<std::uint64_t>(at + at_fingerprint, Order::ABCD),
              codec::decode<std::uint32_t>(at + at_map_size, Order::ABCD),
              codec::decode<std::uint32_t>(at + at_map_crc, Order::ABCD)};
}

std::optional<Report> read_report(const std::array<std::uint16_t, report_size>& area) {
  std::array<std::uint16_t, head_size> first{};
  std::copy_n(area.begin(), first.size(), first.begin());
  auto report = read_report_head(first);
  if (!report) return report;
  const auto counter = [&](std::size_t at) { return codec::decode<std::uint32_t>(&area[at], Order::ABCD); };
  report->has_statistics = true;
  report->uptime = counter(at_uptime);
  for (const Counter& each : counters) report->counts.*each.count = counter(each.at);
  return report;
}

std::optional<Report> read_report_head(const std::array<std::uint16_t, head_size>& area) {
  const auto head = read_head(area);
  if (!head) return {};
  Report report;
  report.head = *head;
  report.watchdog_state = area[at_watchdog_state];
  report.watchdog_left = area[at_watchdog_left];
  return report;
}

Machine machine_of(std::string_view hostname, std::uint64_t serial) {
  Machine machine{serial, {}};
  std::copy_n(hostname.begin(), std::min(hostname.size(), machine.hostname.size()), machine.hostname.begin());
  return machine;
}

std::string_view hostname_of(const Machine& machine) {
  const auto* const end = std::find(machine.hostname.begin(), machine.hostname.end(), '\0');
  return {machine.hostname.data(), static_cast<std::size_t>(end - machine.hostname.begin())};
}

void write_further(const Further& further, std::uint16_t* area) {
  area[at_further] = further_size;
  const Machine& machine = further.machine;
  codec::encode(machine.serial, Order::ABCD, area + at_serial);
  for (std::size_t i = 0; i < machine.hostname.size(); i += 2)
    area[at_hostname + i / 2] =
        static_cast<std::uint16_t>(static_cast<std::uint8_t>(machine.hostname[i]) << 8 |
                                   static_cast<std::uint8_t>(machine.hostname[i + 1]));
  area[at_functions] = static_cast<std::uint16_t>(
      (further.functions.tells_changes ? Functions::tells_changes_bit : 0) |
      (further.functions.schedules_outputs ? Functions::schedules_outputs_bit : 0) |
      (further.functions.has_field_side ? Functions::has_field_side_bit : 0));
  codec::encode(further.watchdog_timeout, Order::ABCD, area + at_watchdog_timeout);
}

Further read_further(Span<const std::uint16_t> further) {
  constexpr std::size_t name = at_hostname - at_serial;
  constexpr std::size_t functions = at_functions - at_serial;
  constexpr std::size_t timeout = at_watchdog_timeout - at_serial;
  Further read;
  Machine& machine = read.machine;
  if (further.size() >= name) machine.serial = codec::decode<std::uint64_t>(further.data(), Order::ABCD);
  for (std::size_t i = name; i < std::min(further.size(), name + hostname_registers); ++i) {
    machine.hostname[2 * (i - name)] = static_cast<char>(further[i] >> 8);
    machine.hostname[2 * (i - name) + 1] = static_cast<char>(further[i] & 0xFF);
  }
  if (further.size() > functions)
    read.functions = {(further[functions] & Functions::tells_changes_bit) != 0,
                      (further[functions] & Functions::schedules_outputs_bit) != 0,
                      (further[functions] & Functions::has_field_side_bit) != 0};
  if (further.size() >= timeout + 2)
    read.watchdog_timeout = codec::decode<std::uint32_t>(&further[timeout], Order::ABCD);
  return read;
}

FileRecord record_at(std::uint32_t first, std::uint32_t map_size) {
  using modbus::records_per_file;
  const std::uint32_t total = (map_size + 1) / 2;
  const std::uint32_t record = first % records_per_file;
  const std::uint32_t left = std::min(total - first, records_per_file - record);
  return {static_cast<std::uint16_t>(1 + first / records_per_file), static_cast<std::uint16_t>(record),
          static_cast<std::uint16_t>(std::min<std::uint32_t>(left, modbus::max_file_registers))};
}

}  // namespace coupler::identity
