// SPDX-License-Identifier: Apache-2.0
#include "coupler/formats/conversion_warnings.hpp"

#include <algorithm>

#include <fmt/format.h>

namespace coupler::formats {
namespace {

std::string list_of(const std::vector<std::string>& points) {
  constexpr std::size_t most = 8;
  std::string text;
  for (std::size_t i = 0; i < std::min(points.size(), most); ++i)
    text += fmt::format("{}{}", i == 0 ? ": " : ", ", points[i]);
  if (points.size() > most) text += fmt::format(" and {} more", points.size() - most);
  return text;
}

bool is_of_the_node(const Point& point) {
  return point.line.present() || is_analogue(point) || point.counter.present() || point.latched.present() ||
         !point.initial.empty() || point.safe != Safe::off;
}

bool is_of_the_driver(const Point& point) {
  const HostOptions& host = point.host;
  return host.publish != HostOptions::Publish::always || host.latch || host.verify_write ||
         host.deadman.present() || host.max_interval.count() > 0 ||
         host.write_function != HostOptions::WriteFunction::automatic ||
         host.write_queue != HostOptions::WriteQueue::latest;
}

}  // namespace

void ConversionWarnings::add(std::string_view what, std::string_view remedy, std::string_view point) {
  auto found = std::find_if(warnings_.begin(), warnings_.end(),
                            [what](const ConversionWarning& loss) { return loss.what == what; });
  if (found == warnings_.end()) found = warnings_.insert(found, {std::string(what), std::string(remedy), {}});
  if (point.empty() || (!found->points.empty() && found->points.back() == point)) return;
  found->points.emplace_back(point);
}

Diagnostics ConversionWarnings::diagnostics(std::string_view file) const {
  Diagnostics out;
  for (const ConversionWarning& loss : warnings_) {
    Diagnostic diagnostic;
    diagnostic.severity = Diagnostic::Severity::warning;
    diagnostic.file = file;
    diagnostic.what = loss.what + list_of(loss.points);
    diagnostic.remedy = loss.remedy;
    out.push_back(std::move(diagnostic));
  }
  return out;
}

void add_sides(const Map& map, ConversionWarnings& warnings) {
  for (const Point& point : map.points) {
    if (is_of_the_node(point))
      warnings.add("lines, channels, counters, initial and safe values are the node's, and left out",
                   "nothing is to be done: the node has the map", point.name);
    if (is_of_the_driver(point))
      warnings.add("how the driver treats points is left out", "look for the like in the other program",
                   point.name);
  }
}

}  // namespace coupler::formats
