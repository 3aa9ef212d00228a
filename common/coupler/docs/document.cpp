// SPDX-License-Identifier: Apache-2.0
#include "coupler/docs/document.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "coupler/map/fingerprint.hpp"
#include "coupler/plan/picture.hpp"

namespace coupler::docs {

Document make_document(const Map& map, Span<const int> lines, Origin origin) {
  Document document;
  document.name = map.name;
  document.fingerprint = fingerprint_text(map.fingerprint);
  document.facts = facts_of(map);
  document.rows.reserve(map.points.size());
  for (std::size_t i = 0; i < map.points.size(); ++i)
    document.rows.push_back(row_of(map.points[i], i < lines.size() ? lines[i] : 0));
  document.mbpoll = mbpoll_commands(map);
  document.ros = ros_commands(map, origin.file);
  document.picture = plan::picture(map, plan::make_read_plan(map), {true, "#point-"});
  document.origin = std::move(origin);
  return document;
}

std::string source_link(const Document& document, const Row& row) {
  if (document.origin.url.empty() || row.line == 0) return {};
  return fmt::format("{}#L{}", document.origin.url, row.line);
}

std::size_t count(const Document& document, Table table) {
  return static_cast<std::size_t>(std::count_if(document.rows.begin(), document.rows.end(),
                                                [&](const Row& row) { return row.table == table; }));
}

}  // namespace coupler::docs
