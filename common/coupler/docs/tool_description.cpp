// SPDX-License-Identifier: Apache-2.0
#include "coupler/docs/tool_description.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "coupler/docs/words.hpp"
#include "coupler/map/joint.hpp"

namespace coupler::docs {
namespace {

/// Returns what moves it: its own output on, or the other one off.
std::string moved_by(std::string_view output, std::string_view other) {
  return output.empty() ? fmt::format("{} off", other) : fmt::format("{} on", output);
}

std::string seen_by(std::string_view sensor, const Tool& tool) {
  if (tool.settle.count() == 0) return fmt::format("{} on", sensor);
  return fmt::format("{} on for {}", sensor, words(tool.settle));
}

std::string arrival(std::string_view sensor, const Tool& tool) {
  return sensor.empty() ? "after " + words(tool.travel) : seen_by(sensor, tool);
}

std::string outputs(const Tool& tool) {
  std::string text = tool.hold ? "" : "off at the end";
  if (tool.direct) text += fmt::format("{}may be written directly", text.empty() ? "" : ", ");
  return text;
}

std::string on_cancel(const Tool& tool) {
  switch (tool.on_cancel) {
    case OnCancel::open: return "opens";
    case OnCancel::close: return "closes";
    case OnCancel::stay: break;
  }
  return {};
}

/// Every tool is a joint, so the joints of all tools are shown, or of none.
bool shows_joints(const Map& map) {
  return std::any_of(map.tools.begin(), map.tools.end(), is_described_as_joint);
}

std::string joint(const Map& map, const Tool& tool) {
  return fmt::format("{}: open {}, closed {}", joint_name(map, tool), tool.positions.open,
                     tool.positions.closed);
}

ToolDescription describe(const Tool& tool) {
  ToolDescription out;
  out.name = tool.name;
  out.closes = moved_by(tool.close, tool.open);
  out.opens = moved_by(tool.open, tool.close);
  out.closed = arrival(tool.closed, tool);
  out.opened = arrival(tool.opened, tool);
  if (!tool.holds.empty()) {
    out.holds = seen_by(tool.holds, tool);
    out.empty = tool.empty == OnEmpty::ok ? "closed" : "fails";
  }
  out.timeout = "after " + words(tool.timeout);
  out.outputs = outputs(tool);
  out.cancel = on_cancel(tool);
  return out;
}

}  // namespace

std::vector<ToolDescription> describe_tools(const Map& map) {
  std::vector<ToolDescription> out;
  const bool with_joint = shows_joints(map);
  for (const Tool& tool : map.tools) {
    out.push_back(describe(tool));
    if (with_joint) out.back().joint = joint(map, tool);
  }
  return out;
}

}  // namespace coupler::docs
