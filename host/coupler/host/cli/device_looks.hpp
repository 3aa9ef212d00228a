// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "coupler/host/cli/snapshot.hpp"
#include "coupler/host/core/sink.hpp"
#include "coupler/host/core/value_table.hpp"
#include "coupler/host/core/wall_time.hpp"
#include "coupler/map/map.hpp"

namespace coupler::cli {

/// Makes snapshots of a device whose points have one rate: after the cycle in which the last of them was read
/// or refused, after each change that the device tells in between, and when it does not answer. No value
/// outlives its look.
class DeviceLooks : public host::Sink {
 public:
  /// `map` is that of the device's thread, and `chosen` has an element for each of its points. They, the
  /// table and the clock must outlive it. `take` gets the snapshots, in the device's thread.
  DeviceLooks(const Map& map, const std::vector<bool>& chosen, const host::ValueTable& values,
              const host::Clock& clock, std::function<void(Snapshot)> take);

  void on_values(Span<const std::uint32_t> /*points*/) override {}
  void on_told(std::uint32_t point) override;
  void on_cycle() override;
  void on_identified(host::Identity::Verdict verdict) override { identity_ = verdict; }
  void on_online(bool /*online*/) override {}
  void on_failure(const host::Error& error) override;
  void on_report(host::Level, const std::string&) override {}
  void on_note(host::Level level, const std::string& text) override;

 private:
  Snapshot look(const std::optional<host::Error>& error) const;
  Reading read(std::uint32_t point, const std::optional<host::Error>& error) const;
  bool is_from_this_look(const host::ValueTable::Value& value) const;
  bool is_whole() const;
  bool is_node() const;
  void begin_look();

  const Map& map_;
  const std::vector<bool>& chosen_;
  const host::ValueTable& values_;
  const host::Clock& clock_;
  const std::function<void(Snapshot)> take_;
  host::WallTime wall_;
  host::Time began_ = host::Time::min();             ///< the look
  int cycles_ = 0;                                   ///< of the look
  std::vector<bool> told_;                           ///< by point: a change was told since the last look
  bool has_chance_ = true;                           ///< a request without a reply is not told yet
  std::optional<host::Identity::Verdict> identity_;  ///< over this connection
  std::vector<std::string> notes_;                   ///< about this connection
  bool has_looked_ = false;                          ///< over this connection
  Snapshot last_;                                    ///< the last one of a device that answered
};

}  // namespace coupler::cli
