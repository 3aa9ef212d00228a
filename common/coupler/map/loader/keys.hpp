// SPDX-License-Identifier: Apache-2.0
// Every key that a map may have, as data: the loader checks maps against it, importers, exporters and the
// schema take their keys from it.
#pragma once

#include <cstdint>
#include <limits>
#include <string_view>
#include <vector>

#include "coupler/base/span.hpp"
#include "coupler/map/table.hpp"

namespace coupler::loader {

/// The places in a map that have keys of their own. Bits, so that a key may belong to several.
enum class Section : std::uint32_t {
  none = 0,
  map = 1,      ///< the top of the file
  mapping = 2,  ///< the tables
  coil = 4,     ///< options of a point, by its table
  discrete_input = 8,
  input_register = 16,
  holding_register = 32,
  coil_line = 64,    ///< `line:` of a coil
  input_line = 128,  ///< `line:` of a discrete input
  limits = 256,
  wire = 512,  ///< one element of `sim:`
  watchdog = 1024,
  edge = 2048,  ///< `counter:` and `latched:`
  scale = 1U << 12U,
  iio = 1U << 13U,
  pwm = 1U << 14U,
  deadman = 1U << 15U,
  defaults = 1U << 16U,
  area = 1U << 17U,  ///< one element of `unreadable:` or `reserve:`
  serial = 1U << 18U,
  security = 1U << 19U,
  role = 1U << 20U,  ///< one of `roles:`
  tls = 1U << 21U,
  tool = 1U << 22U,       ///< one of `tools:`
  positions = 1U << 23U,  ///< `positions:` of a tool
  axis = 1U << 24U,       ///< one of `axes:`
  last = axis
};
constexpr Section operator|(Section a, Section b) {
  return static_cast<Section>(static_cast<unsigned>(a) | static_cast<unsigned>(b));
}
constexpr bool overlap(Section a, Section b) {
  return (static_cast<unsigned>(a) & static_cast<unsigned>(b)) != 0;
}

/// The section of a point's options.
constexpr Section section_of(Table table) { return static_cast<Section>(4U << index(table)); }

/// "a coil", "the map": for messages.
std::string_view describe(Section section);

enum class ValueKind : std::uint8_t {
  integer,
  number,
  boolean,
  text,
  ros_name,    ///< text: a relative ROS name
  host,        ///< text without blanks
  ip_address,  ///< of the node
  choice,
  type,        ///< one of the choices, or another name of it (coupler/codec/type_name.hpp)
  preset,      ///< the name of one
  duration,    ///< with a unit
  seconds,     ///< a duration; a bare number means seconds
  address,     ///< as Addressing says
  value,       ///< of the point's type
  list,        ///< of texts
  section,     ///< only what Key::inside says
  ends,        ///< a list of two different numbers
  raw_values,  ///< bits of the point's type: numbers, and lists of two numbers that are a range
  names,       ///< integer -> identifier
  positions,   ///< value of a point -> number
  points,      ///< name -> point: a map as Key::inside says; for bits just an address is good
  named,       ///< name -> a map as Key::inside says
  patterns,    ///< all, none, or a list of names of points, with '*' and '?'
};

/// A bare number of seconds above it is refused: somebody meant milliseconds.
constexpr int most_bare_seconds = 60;

enum class Owner : std::uint8_t {
  inherited,  ///< a key of ros-modbus-device-driver
  project
};

/// A value is of `kind`. If `inside` is not none, it may also be a map with that section's keys, or with
/// `several` a list of such maps.
struct Key {
  std::string_view name;
  Section sections = Section::none;
  ValueKind kind = ValueKind::text;
  Owner owner = Owner::project;
  std::string_view example;  ///< a good value, as it stands behind "key: "
  std::string_view summary;
  double least = std::numeric_limits<double>::lowest();  ///< numbers; durations in seconds
  double most = std::numeric_limits<double>::max();
  std::string_view choices = {};  ///< separated by "|"
  std::string_view same_as = {};  ///< another spelling of that key
  Section inside = Section::none;
  bool several = false;
  bool bits = false;                    ///< besides its choices, a list of on and off is good
  bool required = false;                ///< where it applies
  std::string_view required_with = {};  ///< not required by itself, but beside that key
  std::string_view needless_with = {};  ///< nor beside this key, which says the same
  std::string_view types = {};          ///< if not empty, only for points of these types, separated by "|"
  std::string_view fallback = {};  ///< what holds when it is absent, as it would be written; empty: nothing
};

Span<const Key> all_keys();

/// The key of that name in the section, or nullptr.
const Key* find_key(std::string_view name, Section section);

/// The sections that have a key of that name.
Section sections_with(std::string_view name);

/// The names of a section's keys.
std::vector<std::string_view> key_names(Section section);

/// The words of Key::choices or Key::types.
std::vector<std::string_view> words(std::string_view joined);

/// Does the key go with points of that type?
bool applies_to(const Key& key, std::string_view type);

}  // namespace coupler::loader
