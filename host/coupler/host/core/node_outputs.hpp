// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "coupler/host/core/change_listener.hpp"
#include "coupler/host/core/scheduled.hpp"

namespace coupler::host {

/// The reason why an outcome is not heard.
inline constexpr const char* told_no_more = "the device no longer reports changes";

/// The scheduled outputs that a node has accepted, until it tells their outcome. Changes of bits are passed
/// on.
class NodeOutputs : public ChangeSink {
 public:
  struct Waiting {
    std::uint16_t number;
    modbus::NodeTime node_due;
    AcceptedWrite what;
    Time told_by;  ///< an outcome that was not told by then was among the changes that were lost
  };

  /// `bits` receives the changes of bits. Both must outlive the object.
  NodeOutputs(ChangeSink& bits, Clock& clock, ScheduledListener& outcomes)
      : bits_(bits), clock_(clock), outcomes_(outcomes) {}

  /// Returns the node's time for `due`. The order of the outputs that wait is kept, and equal times stay
  /// equal, although the mapping moves with each exchange. Returns nullopt if the mapping does not know the
  /// time.
  std::optional<modbus::NodeTime> node_due(Time due, const ClockMapping& mapping) const;
  /// `number`: see ScheduleReply. `node_due`: see ScheduleOutput.
  void add(std::uint16_t number, modbus::NodeTime node_due, const AcceptedWrite& what);
  std::size_t size() const { return waiting_.size(); }
  /// The node's number of the write with that number of ours; nullopt if it does not wait.
  std::optional<std::uint16_t> number_at_node(std::uint32_t number) const;
  /// Those that wait, in the order in which they were accepted.
  const std::vector<Waiting>& waiting() const { return waiting_; }
  /// Returns whether the output with that number of the node's waits.
  bool has(std::uint16_t number) const;
  /// Reports the outcome of an output if it still waits.
  void settle(std::uint16_t number, ScheduledOutcome::Result result, const std::string& reason);
  /// Notes that a write of its own to the point was carried out.
  void on_written(std::uint32_t point);
  /// Reports that the outcomes will not be heard.
  void lose(const std::string& reason);

  void on_change(const modbus::Change& change, std::uint64_t number, Stamp stamp) override;
  void on_gap() override { bits_.on_gap(); }
  void on_new_epoch() override;
  void on_heard(std::uint64_t newest, std::optional<Stamp> stamp) override;
  void on_end() override;
  Time answer_wanted() override { return bits_.answer_wanted(); }

 private:
  template <class Which>
  void settle_if(Which which, ScheduledOutcome::Result result, Stamp at, const std::string& reason);

  ChangeSink& bits_;
  Clock& clock_;
  ScheduledListener& outcomes_;
  std::vector<Waiting> waiting_;
};

}  // namespace coupler::host
