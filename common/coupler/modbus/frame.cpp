// SPDX-License-Identifier: Apache-2.0
#include "coupler/modbus/frame.hpp"

#include <cassert>
#include <cstring>

namespace coupler::modbus {
namespace {

constexpr std::size_t at_protocol = 2;
constexpr std::size_t at_length = 4;
constexpr std::size_t at_unit = 6;
constexpr std::uint16_t min_length = 2;  ///< unit id and function code
constexpr std::uint16_t max_length = 1 + max_pdu_size;

}  // namespace

void put_header(const Frame& to, std::size_t pdu_size, std::uint8_t* adu) {
  put_u16(adu, to.transaction);
  put_u16(adu + at_protocol, 0);
  put_u16(adu + at_length, static_cast<std::uint16_t>(1 + pdu_size));
  adu[at_unit] = to.unit;
}

Span<std::uint8_t> Framer::room() {
  if (begin_ != 0) {
    std::memmove(buffer_.data(), buffer_.data() + begin_, end_ - begin_);
    end_ -= begin_;
    begin_ = 0;
  }
  return Span<std::uint8_t>(buffer_).from(end_);
}

void Framer::filled(std::size_t bytes) {
  assert(bytes <= buffer_.size() - end_);
  end_ += bytes;
}

Framer::Outcome Framer::next() {
  const std::size_t size = end_ - begin_;
  const std::uint8_t* adu = buffer_.data() + begin_;
  if (size < at_unit) return Outcome::nothing;

  const std::uint16_t length = get_u16(adu + at_length);
  if (get_u16(adu + at_protocol) != 0 || length < min_length || length > max_length) return Outcome::bad;
  if (size < at_unit + length) return Outcome::nothing;

  frame_ = {get_u16(adu), adu[at_unit], Bytes(adu + mbap_size, length - std::size_t{1})};
  begin_ += at_unit + length;
  return Outcome::frame;
}

}  // namespace coupler::modbus
