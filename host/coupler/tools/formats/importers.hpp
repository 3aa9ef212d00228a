// SPDX-License-Identifier: Apache-2.0
// Makes maps from another program's file. A format is one function and its row in importers.cpp.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "coupler/base/span.hpp"
#include "coupler/map/diagnostic.hpp"
#include "coupler/map/loader/address.hpp"
#include "coupler/map/loader/document.hpp"
#include "coupler/map/loader/problems.hpp"
#include "coupler/map/owned_map.hpp"

namespace coupler::formats {

/// One device of a foreign file, as the tree that a map's own file would give: the loader's keys, zero-based
/// addresses, and at every entry its place in the foreign file, where the loader then reports its errors. It
/// need not have a name, and its points' names need not be valid.
struct ForeignUnit {
  std::optional<unsigned> unit;  ///< nullopt: the file does not say
  loader::Entry map;
  loader::Position unit_at{};  ///< where it says the unit, if that is not where the map is
};

/// How a table is read, besides what it says itself.
struct ColumnNames {
  std::string column;   ///< "name"
  std::string heading;  ///< "Tag no."
};

struct ImportOptions {
  std::string name;              ///< of the map; empty: the file's own, else made from the file's name
  std::optional<unsigned> unit;  ///< only this one; for a file that does not say any, the map's unit
  loader::Addressing addressing = loader::Addressing::zero_based;  ///< what a table's addresses count
  std::vector<ColumnNames> columns{};                              ///< headings that no word is known for
  std::string device{};                                            ///< of a file with several: its name there
  std::string order{};    ///< of a table's values of several registers that have none: "ABCD"
  std::string strings{};  ///< what 6 of "string[6]" counts: "characters" or "registers"; empty: is asked for
};

/// Reads UTF-8 text without control characters or byte order mark. What makes the file unusable is an error,
/// what a map cannot express is a warning, each with its place. Never throws.
using ReadForeign = std::vector<ForeignUnit> (*)(std::string_view text, const ImportOptions& options,
                                                 loader::Problems& problems);

struct Importer {
  std::string_view name;  ///< at the command line
  std::string_view summary;
  ReadForeign read;
  bool is_table = false;     ///< of any encoding, with ImportOptions::addressing and columns
  bool has_devices = false;  ///< that ImportOptions::device chooses from
};

// A function for each format.

/// A table of points: one row a point, one column a key of the map's points, `table` and `name` among them,
/// in any order. With a column `unit`, one map a unit. docs/import-export.md describes the columns.
std::vector<ForeignUnit> read_csv(std::string_view text, const ImportOptions& options,
                                  loader::Problems& problems);

/// Home Assistant's `modbus:`, in a whole configuration.yaml or alone: what its entities read and write, in a
/// map for each unit id of a hub.
std::vector<ForeignUnit> read_home_assistant(std::string_view text, const ImportOptions& options,
                                             loader::Problems& problems);

/// ModbusPal's projects (.xmpp): the coils and holding registers of its slaves. Registers are UINT; those
/// that an automation feeds as SINT16, SINT32 or FLOAT32 are INT, DINT or REAL. The DTD and other external
/// entities are never read.
std::vector<ForeignUnit> read_modbuspal(std::string_view text, const ImportOptions& options,
                                        loader::Problems& problems);

/// The configuration of pymodbus' simulator (JSON), or one device of it: what its registers hold, which
/// tables show them, and which may be written. Points are named after type and address.
std::vector<ForeignUnit> read_pymodbus(std::string_view text, const ImportOptions& options,
                                       loader::Problems& problems);

/// The files of ros-modbus-device-driver (bitmeal), and maps of this project, which are written in one style.
/// Comments are left out with a warning.
std::vector<ForeignUnit> read_ros_modbus_device_driver(std::string_view text, const ImportOptions& options,
                                                       loader::Problems& problems);

/// Unslave's config.json (https://unserver.xyz/docs/unslave): values of coils (C), discrete inputs (DI),
/// input registers (IR) and holding registers (HR). It has no names and no types: the points are UINT and
/// named after table and address.
std::vector<ForeignUnit> read_unslave(std::string_view text, const ImportOptions& options,
                                      loader::Problems& problems);

/// All of them; what was left out of the build is not there.
Span<const Importer> importers();

/// The importer of that name, or nullptr.
const Importer* find_importer(std::string_view name);

struct ImportedMap {
  std::optional<unsigned> unit;
  std::string text;  ///< a file that the loader takes
  MapPtr map;
};

struct ImportResult {
  std::vector<ImportedMap> maps;  ///< one a unit; none if there are errors
  Diagnostics diagnostics;        ///< errors, and warnings of what was changed or could not be carried over
};

/// Reads the text of a foreign file; `file` names it in the diagnostics. Never throws.
ImportResult import_text(const Importer& importer, std::string_view text, std::string_view file,
                         const ImportOptions& options);

/// The nearest valid ROS name: letters with accents are spelt in ASCII, what is not a letter, digit or '_'
/// becomes '_', and what begins otherwise gets `prefix` in front. '/' stays where a name may have it.
std::string mended_name(std::string_view name, std::string_view prefix);

}  // namespace coupler::formats
