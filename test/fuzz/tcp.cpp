// SPDX-License-Identifier: Apache-2.0
// A device sends anything over Modbus/TCP, in pieces of any size. What the framer takes for a reply has come
// as a whole, with the right transaction and unit, and the reply to the next request is found whatever came
// before.
//   size of the request's PDU, itself, then pieces: size and bytes
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "coupler/host/modbus/tcp_framer.hpp"
#include "coupler/modbus/frame.hpp"
#include "test/fuzz/pieces.hpp"
#include "test/fuzz/require.hpp"

namespace coupler::fuzz {
namespace {

using host::TcpFramer;
using host::TcpRequest;
using modbus::Bytes;
using Outcome = TcpFramer::Outcome;

constexpr std::uint16_t transaction = 0x4D42;
constexpr std::uint8_t unit = 17;

Outcome feed(TcpFramer& framer, const TcpRequest& request, Bytes bytes) {
  auto outcome = framer.next(request);
  if (outcome != Outcome::nothing) return outcome;
  fill(framer, bytes, [&] { return (outcome = framer.next(request)) == Outcome::nothing; });
  return outcome;
}

void check(const TcpFramer& framer, const TcpRequest& request, const std::vector<std::uint8_t>& come) {
  const Bytes pdu = framer.pdu();
  require(!pdu.empty() && pdu.size() <= modbus::max_pdu_size, "a reply has a PDU");
  require((pdu[0] & modbus::exception_bit) == 0 || pdu[0] != (request.function() | modbus::exception_bit) ||
              pdu.size() <= 2,
          "an exception has two bytes at most");
  std::vector<std::uint8_t> reply(modbus::mbap_size);
  modbus::put_header({transaction, unit, {}}, pdu.size(), reply.data());
  reply.insert(reply.end(), pdu.begin(), pdu.end());
  // The length may lie before an exception.
  const auto found = std::search(come.begin(), come.end(), reply.begin(), reply.end());
  require(found != come.end() || !framer.is_trusted(), "it has come as a whole");
}

/// An exception is a reply to everything.
void check_next(TcpFramer& framer, const TcpRequest& request) {
  std::vector<std::uint8_t> reply(modbus::mbap_size);
  modbus::put_header({transaction, unit, {}}, 2, reply.data());
  reply.push_back(request.function() | modbus::exception_bit);
  reply.push_back(2);
  framer.drop();
  require(feed(framer, request, Bytes(reply.data(), reply.size())) == Outcome::reply,
          "the next reply is found behind anything");
}

void receive(Bytes input) {
  const Bytes pdu = take_piece(input, modbus::max_pdu_size);
  if (pdu.empty() || (pdu[0] & modbus::exception_bit) != 0) return;
  TcpRequest request;
  request.set(transaction, unit, pdu);
  TcpFramer framer;
  std::vector<std::uint8_t> come;
  auto outcome = Outcome::nothing;
  while (!input.empty() && outcome == Outcome::nothing) {
    const Bytes piece = take_piece(input, input.size());
    come.insert(come.end(), piece.begin(), piece.end());
    outcome = feed(framer, request, piece);
  }
  if (outcome == Outcome::reply) check(framer, request, come);
  if (outcome == Outcome::bad || !framer.is_trusted()) framer.reset();
  check_next(framer, request);
}

}  // namespace
}  // namespace coupler::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  coupler::fuzz::receive({data, size});
  return 0;
}
