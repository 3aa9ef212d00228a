// SPDX-License-Identifier: Apache-2.0
#include "coupler/device/core/server.hpp"

#include "coupler/map/field_side.hpp"

namespace coupler::device {

std::size_t Server::answer(const modbus::Frame& frame, ClientSession& session, TimePoint now,
                           Span<std::uint8_t> adu) {
  const std::size_t before = end_wait(session, now, adu);
  const bool is_own = frame.unit == unit_ || frame.unit == 0 || frame.unit == 255;
  if (!is_own && !(frame.unit == field_unit && handler_.has_field_side())) {
    ++statistics_.foreign_units;
    return before;
  }
  adu = adu.from(before);
  const auto reply = adu.from(modbus::mbap_size);
  const std::size_t pdu = is_own ? handler_.handle(frame.pdu, session, now, reply)
                                 : handler_.handle_from_field(frame.pdu, session, now, reply);
  if (session.wait) {
    session.wait->transaction = frame.transaction;
    session.wait->unit = frame.unit;
    return before;
  }
  modbus::put_header(frame, pdu, adu.data());
  return before + modbus::mbap_size + pdu;
}

std::size_t Server::answer_waiting(ClientSession& session, TimePoint now, Span<std::uint8_t> adu) {
  if (!session.wait || !is_due(session, now)) return 0;
  return end_wait(session, now, adu);
}

std::size_t Server::end_wait(ClientSession& session, TimePoint now, Span<std::uint8_t> adu) {
  if (!session.wait) return 0;
  const std::size_t pdu =
      changes().reply_to(session, handler_.rights_of(session), now, adu.from(modbus::mbap_size));
  modbus::put_header({session.wait->transaction, session.wait->unit, {}}, pdu, adu.data());
  session.wait.reset();
  return modbus::mbap_size + pdu;
}

}  // namespace coupler::device
