// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <deque>
#include <memory>
#include <string>
#include <vector>

#include "common/map/map.hpp"

namespace coupler {

/// A map built at run time, with everything it points to. It stays where it is: views into it remain valid as
/// long as it lives.
class OwnedMap {
 public:
  OwnedMap();
  ~OwnedMap();
  OwnedMap(const OwnedMap&) = delete;
  OwnedMap& operator=(const OwnedMap&) = delete;

  const Map& map() const { return map_; }

  /// Keeps a copy of `text` and returns a view of it. For builders.
  std::string_view keep(std::string text);
  /// Keeps a copy of the registers.
  Span<const std::uint16_t> keep(std::vector<std::uint16_t> registers);
  Span<const Unreadable> keep(std::vector<Unreadable> areas);
  Span<const WatchdogSequences::Write> keep(std::vector<WatchdogSequences::Write> sequence);
  /// Keeps the list; what its elements view must be kept, too.
  Span<const std::string_view> keep(std::vector<std::string_view> list);

  /// Ends the building: sorts the points and fills in fingerprint and checksum. `head` brings all fields but
  /// those and `points` and `sim`; its views, and those of points and wires, must point into what was kept
  /// here.
  void finish(Map head, std::vector<Point> points, std::vector<SimWire> sim);

 private:
  std::deque<std::string> texts_;
  std::deque<std::vector<std::uint16_t>> registers_;
  std::deque<std::vector<std::string_view>> lists_;
  std::deque<std::vector<Unreadable>> areas_;
  std::deque<std::vector<WatchdogSequences::Write>> sequences_;
  std::vector<Point> points_;
  std::vector<SimWire> sim_;
  Map map_;
};

using MapPtr = std::shared_ptr<const OwnedMap>;

}  // namespace coupler
