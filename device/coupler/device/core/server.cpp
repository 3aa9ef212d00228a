// SPDX-License-Identifier: Apache-2.0
#include "coupler/device/core/server.hpp"

namespace coupler::device {

std::size_t Server::answer(const modbus::Frame& frame, ClientSession& session, TimePoint now,
                           Span<std::uint8_t> adu) {
  if (frame.unit != unit_ && frame.unit != 0 && frame.unit != 255) {
    ++statistics_.foreign_units;
    return 0;
  }
  const std::size_t pdu = handler_.handle(frame.pdu, session, now, adu.from(modbus::mbap_size));
  modbus::put_header(frame, pdu, adu.data());
  return modbus::mbap_size + pdu;
}

}  // namespace coupler::device
