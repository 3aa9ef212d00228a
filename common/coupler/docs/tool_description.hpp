// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "coupler/base/span.hpp"
#include "coupler/docs/text_column.hpp"
#include "coupler/map/map.hpp"

namespace coupler::docs {

/// The texts about one tool, not yet escaped for any format. An empty text is left out.
struct ToolDescription {
  std::string name;
  std::string closes;   ///< "valve_close on"
  std::string opens;    ///< "valve_close off"
  std::string closed;   ///< how it is known to be closed: "sensor_closed on for 30 ms", "after 300 ms"
  std::string opened;   ///< the same of open
  std::string holds;    ///< "part_present on"
  std::string empty;    ///< what becomes of it when it is closed and holds no part: "fails", "closed"
  std::string timeout;  ///< "after 800 ms"
  std::string outputs;  ///< "off at the end, may be written directly"
  std::string cancel;   ///< what it does when its goal is cancelled: "opens"; empty: nothing more
  std::string joint;    ///< "clamp_joint: open 0.04, closed 0"; empty if the map says nothing of joints
};

/// In the order in which tables have them.
constexpr TextColumn<ToolDescription> tool_columns[] = {
    {"tool", &ToolDescription::name},
    {"closes by", &ToolDescription::closes},
    {"opens by", &ToolDescription::opens},
    {"closed", &ToolDescription::closed},
    {"open", &ToolDescription::opened},
    {"holds a part", &ToolDescription::holds},
    {"without a part", &ToolDescription::empty},
    {"stuck", &ToolDescription::timeout},
    {"outputs", &ToolDescription::outputs},
    {"on cancel", &ToolDescription::cancel},
    {"joint", &ToolDescription::joint},
};

constexpr Span<const TextColumn<ToolDescription>> columns_of(const ToolDescription*) { return tool_columns; }

/// In the order of the map.
std::vector<ToolDescription> describe_tools(const Map& map);

}  // namespace coupler::docs
