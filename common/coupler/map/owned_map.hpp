// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <deque>
#include <memory>
#include <memory_resource>
#include <string>
#include <vector>

#include "coupler/map/map.hpp"

namespace coupler {

/// A map built at run time, with everything it points to. It stays where it is: views into it remain valid as
/// long as it lives. All of it is in the memory resource that is the default one when it is made, so a map
/// can be built in memory that processes share.
class OwnedMap {
 public:
  OwnedMap();
  ~OwnedMap();
  /// An empty one, in the default memory resource.
  static std::shared_ptr<OwnedMap> make();
  OwnedMap(const OwnedMap&) = delete;
  OwnedMap& operator=(const OwnedMap&) = delete;

  const Map& map() const { return map_; }

  /// Keeps a copy of `text` and returns a view of it. For builders.
  std::string_view keep(const std::string& text);
  /// Keeps a copy of the registers.
  Span<const std::uint16_t> keep(const std::vector<std::uint16_t>& registers);
  /// Keeps the list; its names must be kept, too.
  Span<const NamedValue> keep(const std::vector<NamedValue>& values);
  Span<const RawRange> keep(const std::vector<RawRange>& ranges);
  Span<const TableRange> keep(const std::vector<TableRange>& areas);
  Span<const WatchdogSequences::Write> keep(const std::vector<WatchdogSequences::Write>& sequence);
  /// Keeps the list; what its elements view must be kept, too.
  Span<const std::string_view> keep(const std::vector<std::string_view>& list);
  Span<const Role> keep(const std::vector<Role>& roles);
  /// Keeps a copy of a role's rights.
  Span<const std::uint8_t> keep(const std::vector<std::uint8_t>& rights);
  Span<const Tool> keep(const std::vector<Tool>& tools);
  Span<const AxisPosition> keep(const std::vector<AxisPosition>& positions);
  Span<const Axis> keep(const std::vector<Axis>& axes);

  /// Ends the building: sorts the points and fills in fingerprint and checksum. `head` brings all fields but
  /// those and `points` and `sim`; its views, and those of points and wires, must point into what was kept
  /// here.
  void finish(Map head, const std::vector<Point>& points, const std::vector<SimWire>& sim);

 private:
  std::pmr::deque<std::pmr::string> texts_;
  std::pmr::deque<std::pmr::vector<std::uint16_t>> registers_;
  std::pmr::deque<std::pmr::vector<std::string_view>> lists_;
  std::pmr::deque<std::pmr::vector<NamedValue>> values_;
  std::pmr::deque<std::pmr::vector<RawRange>> raw_ranges_;
  std::pmr::deque<std::pmr::vector<TableRange>> areas_;
  std::pmr::deque<std::pmr::vector<WatchdogSequences::Write>> sequences_;
  std::pmr::vector<Role> roles_;
  std::pmr::deque<std::pmr::vector<std::uint8_t>> rights_;
  std::pmr::vector<Tool> tools_;
  std::pmr::deque<std::pmr::vector<AxisPosition>> positions_;
  std::pmr::vector<Axis> axes_;
  std::pmr::vector<Point> points_;
  std::pmr::vector<SimWire> sim_;
  Map map_;
};

using MapPtr = std::shared_ptr<const OwnedMap>;

}  // namespace coupler
