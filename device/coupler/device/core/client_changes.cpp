// SPDX-License-Identifier: Apache-2.0
#include "coupler/device/core/client_changes.hpp"

#include <algorithm>
#include <limits>

namespace coupler::device {

using modbus::ChangesReply;
using modbus::Function;

bool ClientChanges::has_news() {
  if (!rights_.are_limited()) return ring_.has_news(request());
  if (begins_anew() || request().seen != session_.heard.number) return true;
  return skip() != nullptr || ring_.newest() > session_.heard.upto;
}

ChangesReply ClientChanges::reply() {
  if (!rights_.are_limited()) return ring_.reply_to(request());
  if (begins_anew()) return begin();
  Heard& heard = session_.heard;
  ChangesReply reply;
  reply.epoch = ring_.epoch();
  // Changes that the client was told before and asks for again are not kept for it.
  std::uint64_t lost = heard.number - request().seen;
  while (reply.count < reply.changes.size()) {
    const ChangeRing::Entry* next = skip();
    // Nobody saw what the node lost, so it may have been for this client.
    const std::uint64_t gap = (next == nullptr ? ring_.newest() : next->number - 1) - heard.upto;
    if (gap == 0 && next == nullptr) break;
    if (gap > 0 && reply.count > 0) break;
    if (gap == 0) reply.changes[reply.count++] = next->change;
    // How many were lost would tell of what it may not hear.
    lost += gap == 0 ? 0 : 1;
    heard.upto += gap == 0 ? 1 : gap;
    ++heard.number;
  }
  reply.lost =
      static_cast<std::uint32_t>(std::min<std::uint64_t>(lost, std::numeric_limits<std::uint32_t>::max()));
  reply.newest = heard.number + count_rest();
  return reply;
}

/// Its numbers are of another epoch or another connection.
bool ClientChanges::begins_anew() const {
  return !session_.heard.has_begun || request().epoch != ring_.epoch() ||
         request().seen > session_.heard.number;
}

ChangesReply ClientChanges::begin() const {
  Heard& heard = session_.heard;
  heard.has_begun = true;
  heard.upto = ring_.newest();
  ChangesReply reply;
  reply.epoch = ring_.epoch();
  reply.newest = heard.number;
  return reply;
}

bool ClientChanges::may_hear(const ChangeRing::Entry& entry) const {
  const modbus::Change& change = entry.change;
  if (!change.is_bit()) return entry.owner == &session_;
  const bool is_coil = change.table == static_cast<std::uint8_t>(Function::read_coils);
  return rights_.may(Right::read, is_coil ? Table::coils : Table::discrete_inputs,
                     modbus::Range::of(change.address, 1));
}

/// The next change that it may hear, unless the node has lost some before it that nobody saw: then the one
/// after those. What it may not hear counts as heard.
const ChangeRing::Entry* ClientChanges::skip() {
  Heard& heard = session_.heard;
  const ChangeRing::Entry* next = ring_.next_after(heard.upto);
  while (next != nullptr && next->number == heard.upto + 1 && !may_hear(*next)) {
    heard.upto = next->number;
    next = ring_.next_after(heard.upto);
  }
  return next;
}

/// How many it can ask for after this reply.
std::uint64_t ClientChanges::count_rest() const {
  std::uint64_t count = 0;
  std::uint64_t upto = session_.heard.upto;
  for (const ChangeRing::Entry* next = ring_.next_after(upto); next != nullptr;
       next = ring_.next_after(upto)) {
    count += (next->number - upto > 1 ? 1 : 0) + (may_hear(*next) ? 1 : 0);
    upto = next->number;
  }
  return count + (ring_.newest() > upto ? 1 : 0);
}

}  // namespace coupler::device
