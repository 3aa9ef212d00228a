// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>
#include <istream>
#include <optional>
#include <string>
#include <vector>

#include <tl/expected.hpp>

#include "coupler/base/span.hpp"
#include "coupler/map/owned_map.hpp"
#include "coupler/modbus/pdu.hpp"
#include "coupler/record/lines.hpp"

namespace coupler::device {

using record::Nanoseconds;

/// A recording, as the points of a map play it.
class Recording {
 public:
  struct Event {
    enum class Kind : std::uint8_t { value, exception, lost, online };
    Nanoseconds at{};  ///< since the beginning of what is played
    Kind kind = Kind::value;
    std::uint32_t point = 0;           ///< index into Map::points; of a value or an exception
    std::uint32_t first_register = 0;  ///< of a value: see registers()
    std::optional<modbus::Exception> exception{};
  };

  /// Reads all of it. Error, which names the line: it is no recording, or its map cannot be used. `map`: null
  /// is the recording's own.
  static tl::expected<Recording, std::string> read(std::istream& text, const std::string& file,
                                                   const MapPtr& map);

  const MapPtr& map() const { return map_; }
  /// In the order of their times. The first ones say how everything was at the beginning.
  Span<const Event> events() const { return {events_.data(), events_.size()}; }
  /// range(point).count() of them, as on the wire.
  const std::uint16_t* registers(const Event& event) const {
    return registers_.data() + event.first_register;
  }
  Nanoseconds length() const { return length_; }
  Nanoseconds wall_at_begin() const { return wall_; }
  /// How often a point was read; 0: it was not recorded.
  Nanoseconds period(std::uint32_t point) const { return periods_[point]; }
  /// Returns whether the recorded device is not a node of this project.
  bool is_foreign() const { return is_foreign_; }
  /// Returns what is not played, and why, a line each.
  const std::vector<std::string>& left_out() const { return left_out_; }

 private:
  MapPtr map_;
  std::vector<Event> events_;
  std::vector<std::uint16_t> registers_;
  std::vector<Nanoseconds> periods_;
  Nanoseconds length_{};
  Nanoseconds wall_{};
  bool is_foreign_ = false;
  std::vector<std::string> left_out_;
};

}  // namespace coupler::device
