// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "coupler/host/cli/change_watch.hpp"
#include "coupler/host/cli/snapshot.hpp"
#include "coupler/host/core/link.hpp"
#include "coupler/host/core/unanswered_reads.hpp"
#include "coupler/plan/planner.hpp"

namespace coupler::cli {

/// Reads a device, and only reads: it makes no write request, arms no watchdog and repeats no output.
///
/// Requests are those of `coupler plan`, with the pauses of the map. One that the device refuses is made in
/// parts, so that a bad address costs only its points; the parts stay apart while the connection lasts. One
/// that has no reply is treated so, too, if others have one before and after; what is left of it is asked
/// seldom. Nothing is read from a place that means something else in the device's own map.
class DeviceReader {
 public:
  /// `chosen` by point. Changes that the device announces go to `use`, if it is not empty: those that come
  /// during a look() are older than its snapshot. What `map` views, and everything given by reference, must
  /// outlive it.
  DeviceReader(const Map& map, const std::vector<bool>& chosen, host::Link& link, host::MapLoader load,
               ChangeWatch::Use use = {});

  /// Reads every chosen point once, after connecting if there is no connection. If the device falls silent,
  /// the snapshot says so and has the readings until then.
  Snapshot look();

  /// Returns then, or before if everything should be looked at anew; a snapshot if the connection has ended
  /// meanwhile: the next look connects again, and the caller is to wait before it.
  std::optional<Snapshot> wait_until(host::Time time);
  /// Returns whether the device tells changes, until the connection ends.
  bool hears_changes() const { return changes_.is_active(); }

 private:
  using ReadSpan = plan::ReadSpan;

  host::Result<> connect();
  /// Into `now_`, and ends the connection.
  void lost(const host::Error& error);
  host::Result<> identify();
  void judge(const host::Identity& identity);
  void plan();
  host::Result<> read_all();
  host::Result<> ask(const ReadSpan& span, std::vector<ReadSpan>& next);
  host::Result<> take(const ReadSpan& span, host::Result<> answer, std::vector<ReadSpan>& next);
  /// The error of a request.
  struct Refusal {
    std::optional<modbus::Exception> code;  ///< nullopt: there was no reply, or none that can be one
    std::string why;
  };
  Refusal refusal(modbus::Exception code) const;
  host::Result<> in_parts(const ReadSpan& span, const Refusal& refusal, std::vector<ReadSpan>& next);
  host::Result<> connect_again();
  host::Result<> without(const ReadSpan& span, const host::Error& error, std::vector<ReadSpan>& next);
  void note(std::string text);
  void keep(const ReadSpan& span);
  void fail(const ReadSpan& span, const Refusal& refusal);
  Reading& reading(std::uint32_t point) { return now_.readings[place_[point]]; }

  Map map_;
  host::MapLoader load_;
  plan::Planner planner_;
  host::DeviceStatistics statistics_;
  host::Link& link_;
  host::Clock& clock_;
  ChangeWatch changes_;
  std::vector<bool> chosen_;
  std::vector<std::size_t> place_;  ///< by point: of its reading
  Snapshot blank_;                  ///< before anything is read
  Snapshot now_;

  std::optional<Unreadable> answered_;  ///< the last request that was
  host::UnansweredReads aside_;
  std::vector<std::string> no_reply_;  ///< by reading: what came instead of one, when it was set aside

  // Valid for the time of a connection.
  bool connected_ = false;
  bool is_node_ = false;  ///< of this project, which knows every function: exception 01 is about rights
  Snapshot known_;        ///< blank_, with what follows from the identity
  std::vector<ReadSpan> spans_;  ///< the requests of a look

  std::array<std::uint16_t, modbus::max_read_bits> registers_{};  ///< bits too, as registers
};

}  // namespace coupler::cli
