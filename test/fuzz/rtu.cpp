// SPDX-License-Identifier: Apache-2.0
// What comes over a serial line, in pieces of any size: what is taken for a reply is a frame of that unit and
// function which has come, and a reply that follows is found whatever came before.
//   size of the request's PDU, itself, then pieces: size and bytes
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "coupler/modbus/rtu_frame.hpp"
#include "test/fuzz/pieces.hpp"
#include "test/fuzz/require.hpp"

namespace coupler::fuzz {
namespace {

using namespace modbus;
using Outcome = RtuFramer::Outcome;
using Frame = std::array<std::uint8_t, max_rtu_size>;

constexpr std::uint8_t unit = 17;

Outcome feed(RtuFramer& framer, Bytes bytes) {
  fill(framer, bytes, [] { return true; });
  return framer.next();
}

void check(const RtuFramer& framer, Bytes request, const std::vector<std::uint8_t>& come) {
  const Bytes pdu = framer.pdu();
  require(!pdu.empty() && pdu.size() <= max_pdu_size, "a reply has a PDU");
  require((pdu[0] & ~exception_bit) == request[0], "it is of the function that was asked for");
  Frame frame{};
  const auto end = frame.begin() + static_cast<std::ptrdiff_t>(put_rtu_frame(unit, pdu, frame.data()));
  require(std::search(come.begin(), come.end(), frame.begin(), end) != come.end(), "it has come as a whole");
}

/// An exception is a reply to everything.
void check_next(RtuFramer& framer, Bytes request) {
  const std::array<std::uint8_t, 2> exception{static_cast<std::uint8_t>(request[0] | exception_bit), 2};
  Frame frame{};
  const std::size_t size = put_rtu_frame(unit, exception, frame.data());
  require(feed(framer, Bytes(frame).first(size)) == Outcome::reply, "a reply is found behind anything");
}

void receive(Bytes input) {
  const Bytes request = take_piece(input, max_pdu_size);
  if (request.empty() || (request[0] & exception_bit) != 0) return;
  RtuFramer framer;
  framer.expect(unit, request);
  std::vector<std::uint8_t> come;
  while (!input.empty()) {
    const Bytes piece = take_piece(input, input.size());
    come.insert(come.end(), piece.begin(), piece.end());
    if (feed(framer, piece) == Outcome::reply) return check(framer, request, come);
  }
  check_next(framer, request);
}

}  // namespace
}  // namespace coupler::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  coupler::fuzz::receive({data, size});
  return 0;
}
