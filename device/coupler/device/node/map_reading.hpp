// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <tl/expected.hpp>

#include "coupler/base/descriptor.hpp"
#include "coupler/device/net/loop.hpp"
#include "coupler/device/node/serve_error.hpp"
#include "coupler/device/supervisor/child.hpp"
#include "coupler/device/supervisor/shared_memory.hpp"
#include "coupler/map/owned_map.hpp"

namespace coupler::device {

/// How a node reads a map. It is called in a process of its own, which has none of the node's lines and
/// sockets, and may take its time.
struct ReadMap {
  /// The error is the first of those that it has logged. Empty: there is no map to read.
  std::function<tl::expected<MapPtr, std::string>()> read;
  int descriptor = -1;  ///< that it needs besides 0 to 2: the log's
  const Map* built_in =
      nullptr;  ///< in place of one that is read, with files that are: those of its `security`

  bool reads_something() const { return read || built_in != nullptr; }
};

/// The map that was read.
struct MapRead {
  MapPtr map{};           ///< null: the one that is built in
  Descriptor settings{};  ///< memory with TlsSettings, if the map has TLS
};

/// A map that is being read in a process of its own. It dies with this one.
class MapReading final : public EventHandler {
 public:
  /// A slow board reads the largest map in a third of it.
  static constexpr std::chrono::seconds timeout{60};

  /// `loop` wakes up when it is done. The error says why it cannot be done.
  static tl::expected<std::unique_ptr<MapReading>, ServeError> start(Loop& loop, const ReadMap& source,
                                                                     TimePoint now);
  MapReading(const MapReading&) = delete;
  MapReading& operator=(const MapReading&) = delete;
  ~MapReading();

  /// It has ended, or its time is over.
  bool is_over(TimePoint now);
  /// Once it is over. The error says what went wrong, with the map or with reading it.
  tl::expected<MapRead, ServeError> take();

  /// In a process that was forked meanwhile: forgets what is being read.
  void leave() { settings_.close(); }

  void ready(TimePoint) override;

 private:
  /// More than the largest map file (loader) needs.
  static constexpr std::size_t room = std::size_t{256} << 20;
  /// The result that the process leaves behind.
  struct Made {
    const OwnedMap* map = nullptr;
  };

  MapReading(Loop& loop, TimePoint now);
  int read(const ReadMap& source, pid_t parent);
  int read_settings_of(const Map& map);
  void leave_text(const std::string& why) const;

  Loop& loop_;
  TimePoint deadline_;
  std::shared_ptr<SharedArena> arena_;
  SharedArray<Made> made_{1};
  Descriptor settings_;  ///< of TLS; or why there is no map, or no settings
  std::optional<Child> child_;
  std::optional<int> status_;
  bool is_watched_ = false;
};

/// The first map of a node, read in the same way, so that this process keeps none of the memory that it took;
/// but for as long as it takes: nothing is served yet, and a signal ends both.
tl::expected<MapRead, ServeError> read_first(const ReadMap& source);

}  // namespace coupler::device
