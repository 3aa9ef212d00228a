// SPDX-License-Identifier: Apache-2.0
#include "coupler/modbus/changes.hpp"

#include <cassert>

#include "coupler/modbus/limits.hpp"

namespace coupler::modbus {
namespace {

constexpr auto function = static_cast<std::uint8_t>(Function::wait_for_changes);
constexpr std::uint8_t version = 1;
constexpr std::size_t reply_head = 35;  ///< bytes before the changes
constexpr std::size_t change_size = 12;
static_assert(reply_head + max_changes * change_size <= max_pdu_size);

}  // namespace

std::size_t build_changes_request(const ChangesRequest& request, Span<std::uint8_t> pdu) {
  assert(pdu.size() >= changes_request_size && request.wait <= longest_wait);
  pdu[0] = function;
  pdu[1] = version;
  put_u16(&pdu[2], request.wait);
  put_u32(&pdu[4], request.epoch);
  put_u64(&pdu[8], request.seen);
  return changes_request_size;
}

tl::expected<ChangesRequest, Exception> parse_changes_request(Bytes pdu) {
  if (pdu.size() != changes_request_size || pdu[1] != version || get_u16(&pdu[2]) > longest_wait)
    return tl::unexpected(Exception::illegal_data_value);
  return ChangesRequest{get_u16(&pdu[2]), get_u32(&pdu[4]), get_u64(&pdu[8])};
}

std::size_t reply_changes(const ChangesReply& reply, Span<std::uint8_t> pdu) {
  assert(reply.count <= max_changes);
  pdu[0] = function;
  pdu[1] = version;
  put_u32(&pdu[2], reply.epoch);
  put_time(&pdu[6], reply.arrived);
  put_time(&pdu[14], reply.replied);
  put_u64(&pdu[22], reply.newest);
  put_u32(&pdu[30], reply.lost);
  pdu[34] = reply.count;
  std::size_t at = reply_head;
  for (const Change& change : reply.all()) {
    pdu[at] = change.table;
    pdu[at + 1] = static_cast<std::uint8_t>(change.kind);
    put_u16(&pdu[at + 2], change.address);
    put_time(&pdu[at + 4], change.at);
    at += change_size;
  }
  return at;
}

tl::expected<ChangesReply, ReplyError> parse_changes_reply(Bytes pdu) {
  const bool is_whole = pdu.size() >= reply_head && pdu[0] == function && pdu[1] == version &&
                        pdu[34] <= max_changes && pdu.size() == reply_head + pdu[34] * change_size;
  if (!is_whole) return tl::unexpected(reply_error(function, pdu));
  ChangesReply reply{get_u32(&pdu[2]),
                     get_time(&pdu[6]),
                     get_time(&pdu[14]),
                     get_u64(&pdu[22]),
                     get_u32(&pdu[30]),
                     pdu[34],
                     {}};
  for (std::size_t i = 0; i < reply.count; ++i) {
    const std::uint8_t* at = &pdu[reply_head + i * change_size];
    reply.changes[i] = {at[0], static_cast<Change::Kind>(at[1]), get_u16(at + 2), get_time(at + 4)};
  }
  return reply;
}

}  // namespace coupler::modbus
