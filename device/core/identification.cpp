// SPDX-License-Identifier: Apache-2.0
#include "device/core/identification.hpp"

#include <array>

#include "common/base/version.hpp"

namespace coupler::node {
namespace {

/// Without the heap that fingerprint_text() needs.
std::array<char, 16> hexadecimal(std::uint64_t value) {
  std::array<char, 16> digits{};
  for (std::size_t i = 0; i < digits.size(); ++i) digits[i] = "0123456789abcdef"[value >> (60 - 4 * i) & 0xF];
  return digits;
}

}  // namespace

tl::expected<std::size_t, modbus::Exception> identify(const Map& map, modbus::ReadDeviceIdentification wanted,
                                                      Span<std::uint8_t> pdu) {
  const auto fingerprint = hexadecimal(map.fingerprint);
  const std::array<modbus::IdentificationObject, 5> objects{{
      {0, "OpenCoupler"},                             // VendorName
      {1, map.name},                                  // ProductCode
      {2, version},                                   // MajorMinorRevision
      {4, map.name},                                  // ProductName
      {5, {fingerprint.data(), fingerprint.size()}},  // ModelName
  }};
  return modbus::reply_device_identification(wanted, objects, pdu);
}

}  // namespace coupler::node
