// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

#include "coupler/device/core/handler.hpp"
#include "coupler/modbus/frame.hpp"

namespace coupler::device {

/// Answers whole ADUs: which unit ids are its own, and the header of the reply.
class Server {
 public:
  /// Answers unit id `unit`, 0 and 255 (TCP 4.4.2.2: what clients use for a device that has none).
  Server(std::uint8_t unit, Handler& handler, Statistics& statistics)
      : unit_(unit), handler_(handler), statistics_(statistics) {}

  /// Writes the reply to `adu` (at least max_adu_size bytes) and returns its size; 0: another unit's request,
  /// which gets no answer. `session` sent the frame.
  std::size_t answer(const modbus::Frame& frame, ClientSession& session, TimePoint now,
                     Span<std::uint8_t> adu);

 private:
  std::uint8_t unit_;
  Handler& handler_;
  Statistics& statistics_;
};

}  // namespace coupler::device
