// SPDX-License-Identifier: Apache-2.0
// What a foreign format must bring to be imported: one function, and its row in importers.cpp.
#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include "coupler/base/span.hpp"
#include "coupler/map/loader/document.hpp"
#include "coupler/map/loader/problems.hpp"

namespace coupler::formats {

/// One device of a foreign file, as the tree that a map's own file would give: the loader's keys, zero-based
/// addresses, and at every entry its place in the foreign file, so that whatever the loader finds wrong is
/// told there. It need not have a name, and its points' names need not be valid.
struct ForeignUnit {
  std::optional<unsigned> unit;  ///< nullopt: the file does not say
  loader::Entry map;
};

/// Reads UTF-8 text without control characters or byte order mark. What makes it useless is an error, what
/// the map cannot say is a warning, each in its place. Never throws.
using ReadForeign = std::vector<ForeignUnit> (*)(std::string_view text, loader::Problems& problems);

struct Importer {
  std::string_view name;  ///< at the command line
  std::string_view summary;
  ReadForeign read;
};

// A function for each format.

/// A table of points: one row a point, one column a key of the map's points, `table` and `name` among them,
/// in any order. With a column `unit`, one map a unit. docs/import-export.md describes the columns.
std::vector<ForeignUnit> read_csv(std::string_view text, loader::Problems& problems);

/// ModbusPal's projects (.xmpp): the coils and holding registers of its slaves. Registers are UINT; those
/// that an automation feeds as SINT16, SINT32 or FLOAT32 are INT, DINT or REAL. Neither the DTD nor any other
/// entity is ever looked at.
std::vector<ForeignUnit> read_modbuspal(std::string_view text, loader::Problems& problems);

/// The files of ros-modbus-device-driver (bitmeal), and maps of this project: they are written again in
/// one style. Comments are told, and go.
std::vector<ForeignUnit> read_origin(std::string_view text, loader::Problems& problems);

/// Unslave's config.json (https://unserver.xyz/docs/unslave): values of coils (C), discrete inputs (DI),
/// input registers (IR) and holding registers (HR). It knows no names and no types: the points are skeletons,
/// UINT, called after their place.
std::vector<ForeignUnit> read_unslave(std::string_view text, loader::Problems& problems);

/// All of them; what was left out of the build is not there.
Span<const Importer> importers();

/// The importer of that name, or nullptr.
const Importer* find_importer(std::string_view name);

}  // namespace coupler::formats
