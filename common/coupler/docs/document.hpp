// SPDX-License-Identifier: Apache-2.0
// The register map of a device for people. It is made once as plain data; each format has one function that
// writes it.
#pragma once

#include <string>
#include <vector>

#include "coupler/base/span.hpp"
#include "coupler/docs/axis_description.hpp"
#include "coupler/docs/drawing.hpp"
#include "coupler/docs/point_description.hpp"
#include "coupler/docs/tool_description.hpp"
#include "coupler/map/map.hpp"

namespace coupler::docs {

/// The origin of the pages, as they show it. It has no time and no folder of this machine, so that the same
/// map gives the same bytes anywhere.
struct Provenance {
  std::string file;     ///< the map's file name, without its folder
  std::string url;      ///< where a reader finds the file, to which "#L12" is added; empty: no links
  std::string version;  ///< of the program that makes them
};

struct Fact {
  std::string label;
  std::string value;
};

/// Settings of one kind, "Connection", "Limits" …
struct FactGroup {
  std::string title;
  std::vector<Fact> facts;
};

/// A line for a shell, and what it does.
struct Command {
  std::string what;
  std::string line;
};

struct Document {
  Provenance provenance;
  std::string name;         ///< the map's: namespace of the topics
  std::string fingerprint;  ///< sixteen hexadecimal digits
  std::vector<FactGroup> facts;
  std::vector<PointDescription> points;  ///< as Map::points
  std::vector<ToolDescription> tools;    ///< as Map::tools
  std::vector<AxisDescription> axes;     ///< as Map::axes
  std::vector<Command> mbpoll;
  std::vector<Command> ros;
  std::vector<Drawing> drawings;
  std::string picture;  ///< the address spaces as an SVG element; its points link to "#point-NAME"
};

/// `lines`: of the points in the file, as LoadResult::point_lines; empty: unknown.
Document make_document(const Map& map, Span<const int> lines, Provenance provenance);

/// The properties of the device as a whole, in a fixed order, without groups that do not concern it.
std::vector<FactGroup> facts_of(const Map& map);

/// mbpoll reads the first point of each address space with the point's type, or as registers if mbpoll does
/// not have that type.
std::vector<Command> mbpoll_commands(const Map& map);

/// The driver makes the topics; the tools of ROS 2 and of ROS 1 show the first readable point, write the
/// first one that may be written, and close the first tool.
std::vector<Command> ros_commands(const Map& map, const std::string& file);

/// The place of the point in the map's file, "device.yaml#L12"; empty if it is unknown.
std::string source_link(const Document& document, const PointDescription& point);

/// How many points are in that table.
std::size_t count(const Document& document, Table table);

/// One HTML page that needs no other file and no network, and is complete without scripts: those only search
/// and sort.
std::string html_page(const Document& document);

/// GitHub-flavoured Markdown: a table for each address space.
std::string markdown_page(const Document& document);

}  // namespace coupler::docs
