// SPDX-License-Identifier: Apache-2.0
// The register map of a device as plain data: made once, written in each format by one emitter.
#pragma once

#include <string>
#include <vector>

#include "coupler/base/span.hpp"
#include "coupler/docs/commands.hpp"
#include "coupler/docs/facts.hpp"
#include "coupler/docs/origin.hpp"
#include "coupler/docs/row.hpp"

namespace coupler::docs {

struct Document {
  Origin origin;
  std::string name;         ///< the map's: namespace of the topics
  std::string fingerprint;  ///< sixteen hexadecimal digits
  std::vector<FactGroup> facts;
  std::vector<Row> rows;  ///< as Map::points
  std::vector<Command> mbpoll;
  std::vector<Command> ros;
  std::string picture;  ///< the address spaces as an SVG element; its points link to "#point-NAME"
};

/// `lines`: of the points in the file, as LoadResult::point_lines; empty: unknown.
Document make_document(const Map& map, Span<const int> lines, Origin origin);

/// Where in the map's file the point stands, "device.yaml#L12"; empty if that is unknown.
std::string source_link(const Document& document, const Row& row);

/// How many rows are of that table.
std::size_t count(const Document& document, Table table);

}  // namespace coupler::docs
