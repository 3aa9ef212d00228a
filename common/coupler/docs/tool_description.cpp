// SPDX-License-Identifier: Apache-2.0
#include "coupler/docs/tool_description.hpp"

#include <algorithm>
#include <iterator>

#include <fmt/format.h>

#include "coupler/docs/words.hpp"

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

}  // namespace

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
  return out;
}

std::vector<ToolColumn> used_columns(const std::vector<ToolDescription>& tools) {
  std::vector<ToolColumn> used;
  std::copy_if(std::begin(tool_columns), std::end(tool_columns), std::back_inserter(used),
               [&](const ToolColumn& column) {
                 return std::any_of(tools.begin(), tools.end(), [&](const ToolDescription& tool) {
                   return !(tool.*column.text).empty();
                 });
               });
  return used;
}

}  // namespace coupler::docs
