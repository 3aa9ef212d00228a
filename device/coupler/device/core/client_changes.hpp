// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "coupler/device/core/change_ring.hpp"
#include "coupler/device/core/client_session.hpp"
#include "coupler/device/core/rights.hpp"
#include "coupler/modbus/changes.hpp"

namespace coupler::device {

/// The changes that one client may hear: bits that it may read, and what became of the outputs that its own
/// connection has scheduled. With limited rights it has numbers of its own, without gaps where there is
/// something that it may not hear, and each connection begins anew. Without limits it hears all, and the
/// numbers are the node's.
class ClientChanges {
 public:
  /// The session waits. All of them outlive it.
  ClientChanges(const ChangeRing& ring, const Rights& rights, ClientSession& session)
      : ring_(ring), rights_(rights), session_(session) {}

  /// Returns whether there is something to tell.
  bool has_news();
  /// The reply but for its times.
  modbus::ChangesReply reply();

 private:
  const modbus::ChangesRequest& request() const { return session_.wait->request; }
  bool begins_anew() const;
  bool may_hear(const ChangeRing::Entry& entry) const;
  const ChangeRing::Entry* skip();
  modbus::ChangesReply begin() const;
  std::uint64_t count_rest() const;

  const ChangeRing& ring_;
  const Rights& rights_;
  ClientSession& session_;
};

}  // namespace coupler::device
