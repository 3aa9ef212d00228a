// SPDX-License-Identifier: Apache-2.0
#include "coupler/device/core/identity.hpp"

#include <algorithm>
#include <array>
#include <cstring>
#include <utility>

#include "coupler/base/version.hpp"
#include "coupler/codec/number.hpp"
#include "coupler/modbus/limits.hpp"

namespace coupler::device {
namespace {

Span<std::uint16_t> area_of(Image& image) {
  return image.find(Table::input_registers, modbus::Range::of(identity::reserved.start(), identity::size));
}

/// Without the heap that fingerprint_text() needs.
std::array<char, 16> hexadecimal(std::uint64_t value) {
  std::array<char, 16> digits{};
  for (std::size_t i = 0; i < digits.size(); ++i) digits[i] = "0123456789abcdef"[value >> (60 - 4 * i) & 0xF];
  return digits;
}

/// Unrolled, not a loop: a loop would put the names of the counters into a microcontroller's flash.
template <std::size_t... i>
void write_counts(const identity::Counts& counts, std::uint16_t* area, std::index_sequence<i...>) {
  (codec::encode(counts.*identity::counters[i].count, codec::Order::ABCD, area + identity::counters[i].at),
   ...);
}

}  // namespace

void write_identity(const Map& map, const identity::Machine& machine, const identity::Functions& functions,
                    Image& image) {
  const auto area = area_of(image);
  identity::write_head(identity::head_of(map), area.data());
  const auto timeout = static_cast<std::uint32_t>(map.service.watchdog.timeout.count());
  identity::write_further({machine, functions, timeout}, area.data());
}

void write_statistics(const Statistics& statistics, TimePoint now, Image& image) {
  const auto area = area_of(image);
  const auto uptime = std::chrono::duration_cast<std::chrono::seconds>(now - statistics.started);
  codec::encode(static_cast<std::uint32_t>(uptime.count()), codec::Order::ABCD, &area[identity::at_uptime]);
  write_counts(statistics, area.data(), std::make_index_sequence<identity::counters.size()>());
}

void write_watchdog(const OutputWatchdog& watchdog, TimePoint now, Image& image) {
  const auto area = area_of(image);
  area[identity::at_watchdog_state] = static_cast<std::uint16_t>(watchdog.state());
  area[identity::at_watchdog_left] =
      static_cast<std::uint16_t>(std::min<std::int64_t>(watchdog.left(now).count(), 0xFFFF));
}

tl::expected<std::size_t, modbus::Exception> identify(const Map& map, const identity::Machine& machine,
                                                      modbus::ReadDeviceIdentification wanted,
                                                      Span<std::uint8_t> pdu) {
  const auto fingerprint = hexadecimal(map.fingerprint);
  const auto serial = hexadecimal(machine.serial);
  std::array<modbus::IdentificationObject, 7> objects{{
      {0, "OpenCoupler"},                             // VendorName
      {1, map.name},                                  // ProductCode
      {2, version},                                   // MajorMinorRevision
      {4, map.name},                                  // ProductName
      {5, {fingerprint.data(), fingerprint.size()}},  // ModelName
  }};
  std::size_t count = 5;
  if (const auto hostname = identity::hostname_of(machine); !hostname.empty())
    objects[count++] = {6, hostname};  // UserApplicationName
  if (machine.serial != 0) objects[count++] = {0x80, {serial.data(), serial.size()}};
  return modbus::reply_device_identification(
      wanted, Span<const modbus::IdentificationObject>(objects.data(), count), pdu);
}

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
