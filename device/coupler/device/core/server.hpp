// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>

#include "coupler/device/core/handler.hpp"
#include "coupler/modbus/frame.hpp"

namespace coupler::device {

/// Answers whole ADUs: which unit ids are its own, and the header of the reply.
class Server {
 public:
  /// Answers unit id `unit`, 0 and 255 (TCP 4.4.2.2: what clients use for a device that has none).
  Server(std::uint8_t unit, Handler& handler, Statistics& statistics)
      : unit_(unit), handler_(handler), statistics_(statistics) {}

  /// See Hooks.
  bool answers() const { return handler_.answers(); }

  /// Writes the reply to `adu` and returns its size; 0: another unit's request, which gets no answer, or one
  /// that waits for changes (session.wait). `session` sent the frame, which arrived at `now`. `adu` has at
  /// least max_adu_size bytes, and twice as many if the session waits already: that is answered first.
  std::size_t answer(const modbus::Frame& frame, ClientSession& session, TimePoint now,
                     Span<std::uint8_t> adu);

  /// To be called for each session that waits after answer(), after Handler::tick(), and when its time is
  /// over (session.wait->until). Writes the reply that is sent now to `adu` (at least max_adu_size bytes) if
  /// it is due, and returns its size; else 0.
  std::size_t answer_waiting(ClientSession& session, TimePoint now, Span<std::uint8_t> adu);

  /// The same, due or not: what the session waits for has to end. 0: it does not wait.
  std::size_t end_wait(ClientSession& session, TimePoint now, Span<std::uint8_t> adu);

  /// The connection has ended: what it has scheduled is cancelled.
  void end_session(const ClientSession& session, TimePoint now) { handler_.end_session(session, now); }

  const Changes& changes() const { return handler_.changes(); }
  /// See Handler::role_of().
  const Role* role_of(std::string_view name) const { return handler_.role_of(name); }
  /// Returns whether there is a point that the client may write.
  bool may_write(const ClientSession& session) const { return handler_.rights_of(session).may_write_any(); }
  /// Returns whether the session's wait has to be answered now.
  bool is_due(ClientSession& session, TimePoint now) const {
    return handler_.changes().is_due(session, handler_.rights_of(session), now);
  }

 private:
  std::uint8_t unit_;
  Handler& handler_;
  Statistics& statistics_;
};

}  // namespace coupler::device
