// SPDX-License-Identifier: Apache-2.0
#include "coupler/modbus/frame.hpp"

namespace coupler::modbus {
namespace {

constexpr std::uint16_t min_length = 2;  ///< unit id and function code
constexpr std::uint16_t max_length = 1 + max_pdu_size;

}  // namespace

std::size_t adu_size(Bytes adu) {
  const std::uint16_t length = get_u16(&adu[at_length]);
  const bool is_valid = get_u16(&adu[at_protocol]) == 0 && length >= min_length && length <= max_length;
  return is_valid ? at_unit + std::size_t{length} : 0;
}

void put_header(const Frame& to, std::size_t pdu_size, std::uint8_t* adu) {
  put_u16(adu, to.transaction);
  put_u16(adu + at_protocol, 0);
  put_u16(adu + at_length, static_cast<std::uint16_t>(1 + pdu_size));
  adu[at_unit] = to.unit;
}

Framer::Outcome Framer::next() {
  const Bytes adu = rest();
  if (adu.size() < at_unit) return Outcome::nothing;
  const std::size_t size = adu_size(adu);
  if (size == 0) return Outcome::bad;
  if (adu.size() < size) return Outcome::nothing;

  frame_ = {get_u16(adu.data()), adu[at_unit], adu.first(size).from(mbap_size)};
  buffer_.take(size);
  return Outcome::frame;
}

}  // namespace coupler::modbus
