// SPDX-License-Identifier: Apache-2.0
#include "coupler/device/core/identification.hpp"

#include <array>

#include "coupler/base/version.hpp"

namespace coupler::device {
namespace {

/// Without the heap that fingerprint_text() needs.
std::array<char, 16> hexadecimal(std::uint64_t value) {
  std::array<char, 16> digits{};
  for (std::size_t i = 0; i < digits.size(); ++i) digits[i] = "0123456789abcdef"[value >> (60 - 4 * i) & 0xF];
  return digits;
}

}  // namespace

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

}  // namespace coupler::device
