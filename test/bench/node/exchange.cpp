// SPDX-License-Identifier: Apache-2.0
#include "exchange.hpp"

namespace coupler::bench {

Adu adu(std::initializer_list<std::uint8_t> pdu, const Adu& data) {
  constexpr std::uint8_t any_unit = 255;
  const auto length = static_cast<std::uint8_t>(1 + pdu.size() + data.size());
  Adu bytes{0, 0, 0, 0, 0, length, any_unit};
  bytes.insert(bytes.end(), pdu);
  bytes.insert(bytes.end(), data.begin(), data.end());
  return bytes;
}

namespace {

Case read_registers() {
  Adu values;
  for (std::uint8_t i = 0; i < 10; ++i) values.insert(values.end(), {0xA0, i});
  return {Exchange{adu({16, 0, 0, 0, 10, 20}, values), adu({16, 0, 0, 0, 10})},
          {{adu({3, 0, 0, 0, 10}), adu({3, 20}, values)}}};
}

Case read_coils() {
  const Adu values{0x55, 0xCD, 0x0F, 0x81};
  return {Exchange{adu({15, 0, 0, 0, 32, 4}, values), adu({15, 0, 0, 0, 32})},
          {{adu({1, 0, 0, 0, 32}), adu({1, 4}, values)}}};
}

Case write_coil() {
  const Adu on = adu({5, 0, 32, 0xFF, 0});
  const Adu off = adu({5, 0, 32, 0, 0});
  return {std::nullopt, {{on, on}, {off, off}}};
}

}  // namespace

std::optional<Case> find_case(std::string_view name) {
  if (name == "fc3") return read_registers();
  if (name == "fc1") return read_coils();
  if (name == "fc5") return write_coil();
  return std::nullopt;
}

}  // namespace coupler::bench
