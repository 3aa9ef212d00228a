// SPDX-License-Identifier: Apache-2.0
// The entities of Home Assistant's modbus integration as points of a map.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "coupler/base/span.hpp"
#include "coupler/map/loader/document.hpp"
#include "coupler/map/loader/problems.hpp"
#include "coupler/map/table.hpp"
#include "coupler/tools/formats/exporters.hpp"

namespace coupler::formats {

/// The keys of one part of the file. Those that nobody asks for are reported at the end.
class Settings {
 public:
  Settings(const loader::Entry& given, loader::Problems& problems) : given_(given), problems_(problems) {}

  loader::Position at() const { return given_.at; }
  loader::Problems& problems() const { return problems_; }

  /// nullptr if it is not there, or null.
  const loader::Entry* find(std::string_view key);
  /// The fallback if it is not there.
  std::string text(std::string_view key, std::string_view fallback);
  /// nullopt if it is not there; an error, and nullopt, if it is not a whole number up to `most`.
  std::optional<unsigned> whole(std::string_view key, unsigned most);
  /// nullopt if it is not there; an error, and nullopt, if it is not a number.
  std::optional<double> number(std::string_view key);
  /// False if it is not there; an error, and false, if it is neither true nor false.
  bool flag(std::string_view key);
  /// Nothing is to be said of this one.
  void ignore(std::string_view key) { used_.emplace(key); }
  /// Warns of the keys that are left.
  void report_rest() const;

 private:
  const loader::Entry& given_;
  loader::Problems& problems_;
  std::set<std::string, std::less<>> used_;
};

/// nullopt if it is not a whole number up to `most`. 010 is 8 as in Home Assistant's YAML, with a warning.
std::optional<unsigned> whole_of(const loader::Entry& given, unsigned most, loader::Problems& problems);

/// The use that Home Assistant makes of a point.
enum class PointUse : std::uint8_t { read, write, both };

/// A point before it is a part of the map.
struct FoundPoint {
  loader::Entry entry;  ///< its name and keys, without those that the members below say
  Table table = Table::coils;
  unsigned address = 0;
  unsigned size = 1;            ///< registers or bits
  std::uint16_t mask = 0xFFFF;  ///< the bits that it has of a register
  PointUse use = PointUse::both;
  std::optional<unsigned> read_address{};
  bool write_multiple = false;  ///< Home Assistant writes it with function code 15 or 16
  unsigned interval = 0;        ///< seconds between two reads; 0: it is not read by itself
};

/// The points of one unit id. Where two entities share a place, the first that writes has it, or else the
/// first in the file.
class UnitPoints {
 public:
  void add(FoundPoint point, loader::Problems& problems);

  /// Gives each point its place, once all are added.
  void settle(loader::Problems& problems);

  /// Returns the place of its first unit id, or of its first entity.
  loader::Position at() const { return at_; }
  void begin_at(loader::Position at) {
    if (at_.line == 0) at_ = at;
  }

  /// `mapping:`, and the rate at which the map is read.
  std::vector<loader::Entry> take(loader::Position at);

 private:
  struct Owner {
    std::uint16_t mask = 0;
    std::size_t point = 0;  ///< of points_
  };
  using Owners = std::map<std::pair<Table, unsigned>, std::vector<Owner>>;

  FoundPoint* owner_of(const Owners& owners, const FoundPoint& point, unsigned address);
  void claim(Owners& owners, const FoundPoint& point, unsigned address) const;
  void give_place(FoundPoint point, loader::Problems& problems);

  loader::Position at_;
  std::vector<FoundPoint> added_;   ///< without a place
  std::vector<FoundPoint> points_;  ///< with one
  Owners read_;
  Owners written_;
};

/// The points of all units of a hub.
using HubPoints = std::map<unsigned, UnitPoints>;

/// One value of an entity's registers, as its `data_type` or `structure` says it.
struct RegisterValue {
  std::string suffix;            ///< behind the entity's name: "_0", if there are several
  unsigned register_offset = 0;  ///< from the entity's address
  unsigned registers = 1;
  std::uint16_t mask = 0xFFFF;
  std::vector<loader::Entry> keys;  ///< type, order, length …
  bool is_number = true;
};

/// Returns how many values follow each other: one, and those of `virtual_count` or `slave_count`, its older
/// name.
unsigned elements_of(Settings& settings, unsigned most);

/// Empty, with the reason in the problems, if the map has no type for it.
std::vector<RegisterValue> read_data_type(Settings& settings);

/// Numbers of a register and what they are called, in the order of the numbers.
using Names = std::map<unsigned, std::string>;

/// One entity of a list, and what the platforms' readers have in common.
class Entity {
 public:
  Entity(const loader::Entry& given, HubPoints& points, ConversionWarnings& losses,
         loader::Problems& problems)
      : given_(given), settings_(given, problems), points_(points), losses_(losses) {}

  /// Name, address, unit and interval. False, with an error, if it has no place.
  bool read_place();
  /// Warns of what has not been read.
  void report_rest();

  const loader::Entry& given() const { return given_; }
  const std::string& name() const { return name_; }
  unsigned address() const { return address_; }
  Settings& settings() { return settings_; }

  /// The whole import's warning of that kind, with the names of its entities, at the first one's `key`, or at
  /// its name.
  void lose(std::string_view what, std::string_view remedy, std::string_view key = "name");

  /// "holding" or "coils", as `key` says it.
  static Table table_of(std::string_view key, std::string_view fallback, Settings& settings);
  /// "holdings" and "coils": the table is written with function code 16 or 15.
  static bool writes_multiple(std::string_view key, Settings& settings);
  /// The word for it: "holding".
  static std::string_view word_of(Table table);

  FoundPoint point(const std::string& suffix, Table table, unsigned address, PointUse use) const;
  /// A bit; or a register, with names for its numbers: the only ones that Home Assistant writes.
  FoundPoint named(const std::string& suffix, Table table, unsigned address, PointUse use,
                   const Names& names) const;
  FoundPoint with_value(const RegisterValue& value, const std::string& suffix, Table table, unsigned address,
                        PointUse use) const;
  void scale(FoundPoint& point, double gain, double offset) const;
  void add(FoundPoint point);

  /// Adds a number or a list of them. The second one of a name is NAME_2: a map wants each name once.
  void add_numbers(const loader::Entry& given, const std::string& name, Names& names) const;

 private:
  const loader::Entry& given_;
  Settings settings_;
  HubPoints& points_;
  ConversionWarnings& losses_;
  std::string name_;
  unsigned address_ = 0;
  unsigned unit_ = 1;
  unsigned interval_ = 0;
};

/// Returns the unit id of an entity: its `device_address`, or else its `slave`; nullptr if it has neither.
const loader::Entry* unit_of(const loader::Entry& entity);

/// Reads one climate.
void add_climate(Entity& entity);

/// The lists of entities, in the order in which they get places: first what can be written.
Span<const std::string_view> entity_platforms();

/// Adds the points of one entity of the list `platform`. `losses` takes what concerns several alike.
void add_entity(std::string_view platform, const loader::Entry& entity, HubPoints& points,
                ConversionWarnings& losses, loader::Problems& problems);

}  // namespace coupler::formats
