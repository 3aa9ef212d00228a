// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/panel/loop_check.hpp"

#include <fmt/format.h>

#include "coupler/docs/point_description.hpp"
#include "coupler/plan/explain.hpp"

namespace coupler::host {
namespace {

std::string line(const std::string& name, const Seen& seen, const docs::PointDescription& point,
                 const std::string& part) {
  return fmt::format("{},{},{},{},{},{},{},{}\r\n", name, seen.off ? "yes" : "no", seen.on ? "yes" : "no",
                     seen.changes, to_string(point.table), point.first,
                     plan::modicon(point.table, point.first), part);
}

}  // namespace

std::string loop_check_head() { return "point,seen_off,seen_on,changes,table,address,modicon,part\r\n"; }

std::string loop_check_lines(const Point& point, const Seen& seen, const WordBits* bits) {
  const docs::PointDescription said = docs::describe(point, 0);
  std::string text = line(said.name, seen, said, said.part);
  for (unsigned bit = 0; bits != nullptr && bit < bits->count(); ++bit)
    text += line(fmt::format("{}.{}", said.name, bit),
                 {bits->was_off(bit), bits->was_on(bit), bits->changes(bit)}, said,
                 fmt::format("bit {}{}{}", bit, said.part.empty() ? "" : " of ", said.part));
  return text;
}

}  // namespace coupler::host
