// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "coupler/host/core/sink.hpp"
#include "coupler/host/core/value_table.hpp"
#include "coupler/host/core/wall_time.hpp"
#include "coupler/map/map.hpp"
#include "coupler/tools/snapshot.hpp"

namespace coupler::tools {

/// Makes snapshots of a device whose points all have the same rate. It makes one when each point has been
/// read or refused, or after three cycles; one for each change that the device announces in between; and
/// one when the device does not answer. No value is kept for the next look.
class DeviceLooks : public host::Sink {
 public:
  /// `map` is the map that the device's thread uses, and `chosen` has an element for each of its points.
  /// All references must outlive the object. `take` is called with each snapshot in the device's thread;
  /// there, too, once, `on_silence` when a request had no answer, which is no failure yet.
  DeviceLooks(
      const Map& map, const std::vector<bool>& chosen, const host::ValueTable& values,
      const host::Clock& clock, std::function<void(Snapshot)> take, std::function<void()> on_silence = [] {});

  void on_values(Span<const std::uint32_t> /*points*/) override {}
  void on_told(std::uint32_t point) override;
  void on_cycle() override;
  void on_identified(host::Identity::Verdict verdict) override { identity_ = verdict; }
  void on_online(bool /*online*/) override {}
  void on_failure(const host::Error& error) override;
  void on_report(host::Level, const std::string&) override {}
  void on_note(host::Level level, const std::string& text) override;

 private:
  void tell_of_silence();
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
  std::function<void()> on_silence_;  ///< empty: it was called
  host::WallTime wall_;
  host::Time began_ = host::Time::min();             ///< the time at which this look began
  int cycles_ = 0;                                   ///< the number of cycles in this look
  std::vector<bool> told_;                           ///< by point: a change was told since the last look
  bool has_chance_ = true;                           ///< the next missing reply need not be reported
  std::optional<host::Identity::Verdict> identity_;  ///< the verdict over this connection
  std::vector<std::string> notes_;                   ///< the notes about this connection
  bool has_looked_ = false;                          ///< a look has ended over this connection
  Snapshot last_;                                    ///< the last snapshot without an error
};

}  // namespace coupler::tools
