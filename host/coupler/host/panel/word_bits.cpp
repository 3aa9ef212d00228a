// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/panel/word_bits.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "coupler/codec/bit_string.hpp"

namespace coupler::host {

unsigned bits_of(const Point& point) {
  if (!is_readable(point) || point.count > 1 || !codec::is_bit_string(point.format.type)) return 0;
  return point.format.bits != 0 ? point.format.bits : codec::width(point.format.type);
}

void WordBits::take(std::uint64_t word, Time at) {
  const std::uint64_t all = ~std::uint64_t{0} >> (64 - count());
  const BitsStep now{word & all, ~word & all};
  const std::uint64_t changed = word_ ? (*word_ ^ word) & all : 0;
  for (unsigned bit = 0; bit < count(); ++bit) changes_[bit] += changed >> bit & 1;
  word_ = word;
  seen_.add(now);
  history_.take(now, at);
}

nlohmann::ordered_json WordBits::json() const {
  nlohmann::ordered_json json{
      {"on", fmt::format("{:x}", seen_.on)}, {"off", fmt::format("{:x}", seen_.off)}, {"changes", changes_}};
  if (word_) json["is"] = fmt::format("{:x}", *word_);
  return json;
}

}  // namespace coupler::host
