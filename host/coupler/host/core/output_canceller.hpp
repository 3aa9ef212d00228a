// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "coupler/host/core/call_queue.hpp"
#include "coupler/host/core/change_listener.hpp"
#include "coupler/host/core/link.hpp"
#include "coupler/host/core/node_outputs.hpp"
#include "coupler/host/core/scheduled.hpp"
#include "coupler/host/core/scheduled_writes.hpp"

namespace coupler::host {

/// The beginning of an answer that does not know what becomes of a write.
inline constexpr std::string_view in_doubt = "it may or may not be carried out: ";

/// Cancels scheduled writes: those that the driver makes at once, and those at a node by requests. A node
/// cancels many with one request; an older one has to be asked for each.
///
/// Only the thread that uses the link may use the object.
class OutputCanceller {
 public:
  struct Counts {
    std::size_t wanted = 0;
    std::size_t cancelled = 0;
  };

  /// All references must outlive the object.
  OutputCanceller(const Map& map, Link& link, ScheduledWrites& by_driver, NodeOutputs& by_node)
      : map_(map), link_(link), by_driver_(by_driver), by_node_(by_node) {}

  /// Starts with a new connection.
  void connected() { asks_for_each_ = false; }

  // Each of these answers a call of a client. An error means that the connection can no longer be used.
  Result<> answer(std::uint32_t number, Reply<CallAnswer>& to, const ChangeListener& listener);
  Result<> answer(const WritesFrom& which, Reply<CallAnswer>& to, const ChangeListener& listener);

  /// Cancels those that the driver makes and has not sent.
  Counts cancel_by_driver(const WritesFrom& which, const std::string& reason);
  /// Cancels those at the node that have not begun, and adds to `counts`. An error means that the connection
  /// can no longer be used.
  Result<> cancel_at_node(const WritesFrom& which, const std::string& reason, const ChangeListener& listener,
                          Counts& counts);

 private:
  /// An output that waits at the node.
  struct Output {
    std::uint16_t number;
    modbus::NodeTime due;
    Table table;
    modbus::Range range;
  };
  /// Outputs with neighbouring addresses.
  struct Group {
    Table table;
    modbus::Range range;
    std::vector<Output> outputs;
  };

  static bool overlap(Table table, modbus::Range range, const std::vector<Output>& outputs);
  static std::vector<Group> groups_of(std::vector<Output> wanted, const std::vector<Output>& others);
  Output output(const NodeOutputs::Waiting& waiting) const;
  Result<bool> cancel(const Group& group, modbus::NodeTime from, const std::string& reason,
                      const ChangeListener& listener, Counts& counts);
  std::size_t settle(const Group& group, const modbus::ScheduleReply& reply, const std::string& reason);
  Result<> cancel(std::uint16_t number, const std::string& reason, const ChangeListener& listener);

  const Map& map_;
  Link& link_;
  ScheduledWrites& by_driver_;
  NodeOutputs& by_node_;
  bool asks_for_each_ = false;  ///< the node cancels only one with a request
};

}  // namespace coupler::host
