// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <functional>
#include <string>

#include "coupler/host/core/change_listener.hpp"
#include "coupler/host/core/node_map.hpp"

namespace coupler::cli {

/// Hands on the changes that a node announces, as they come.
class ChangeWatch : private host::ChangeSink, private host::Sink {
 public:
  using Use = std::function<void(const modbus::Change& bit, host::Stamp stamp)>;
  using Note = std::function<void(std::string text)>;

  /// `use` may be empty: then nothing is asked for. It may be called whenever something is read. Everything
  /// given by reference must outlive it.
  ChangeWatch(const Map& map, host::Link& link, host::DeviceStatistics& statistics, Use use, Note note);

  /// A new connection. Asks for changes before anything else is read, so that none is missed. An error means
  /// that the connection can no longer be used.
  host::Result<> start(bool is_node);
  /// The connection has ended.
  void lost();
  /// The device announces its changes.
  bool is_active() const { return listener_.is_active(); }
  /// Waits until then; returns early if everything should be read once more, or after the link's wake().
  host::Result<> wait_until(host::Time time);

 private:
  void on_change(const modbus::Change& change, std::uint64_t number, host::Stamp stamp) override;
  void on_gap() override { missed_ = true; }
  void on_heard(std::uint64_t, std::optional<host::Stamp>) override {}
  void on_end() override {}
  host::Time answer_wanted() override { return host::Time::max(); }

  void on_values(Span<const std::uint32_t>) override {}
  void on_online(bool) override {}
  void on_report(host::Level, const std::string& text) override { note_(text); }

  bool wanted_;
  host::Link& link_;
  host::Clock& clock_;
  Use use_;
  Note note_;
  host::ChangeListener listener_;
  bool missed_ = false;  ///< since all was read
  int unheard_ = 0;      ///< connections in a row that ended without an answer
};

}  // namespace coupler::cli
