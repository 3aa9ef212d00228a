// SPDX-License-Identifier: Apache-2.0
#include "coupler/map/loader/map_keys.hpp"

#include <algorithm>
#include <unordered_map>

#include <fmt/format.h>

#include "coupler/map/loader/nearest.hpp"

namespace coupler::loader {
namespace {

class SimReader {
 public:
  SimReader(const DraftPoints& points, Context& context) : context_(context) {
    for (const DraftPoint& draft : points) tables_.emplace(draft.point.name, draft.point.table);
  }

  SimWire wire(const Entry& entry) {
    const Reader reader(entry, Section::wire, context_);
    SimWire wire;
    reader.fields(wire);
    check_source(reader, entry);
    if (const Entry* to = reader.find("to"))
      check_input(*to);
    else
      context_.problems.error(entry.at, "the wire has no 'to'",
                              "add 'to: NAME', the discrete input at its end");
    return wire;
  }

 private:
  void check_source(const Reader& reader, const Entry& wire) {
    const Entry* from = reader.find("from");
    if ((from != nullptr) == reader.has("square"))
      context_.problems.error(
          wire.at, "the wire has either 'from' or 'square'",
          "write it as in '{from: valve, to: valve_is_open}' or '{square: 1s, to: pulse}'");
    if (from != nullptr) check_end(*from, Table::coils);
    if (from == nullptr && reader.has("invert"))
      context_.problems.error(reader.find("invert")->key_at, "'invert' is for a wire with 'from'",
                              "remove it");
  }

  void check_input(const Entry& to) {
    check_end(to, Table::discrete_inputs);
    const auto [first, is_new] = sources_.emplace(to.text, to.at);
    if (!is_new && to.kind == Entry::Kind::scalar)
      context_.problems.error(
          to.at, fmt::format("{} already has a wire, in line {}", shown(to.text), first->second.line),
          "keep one wire for each input", {{first->second, "it is here"}});
  }

  void check_end(const Entry& end, Table table) {
    if (end.kind != Entry::Kind::scalar) return;  // a problem already
    const auto found = tables_.find(end.text);
    if (found != tables_.end() && found->second == table) return;
    const std::string_view expected = table == Table::coils ? "a coil" : "a discrete input";
    if (found == tables_.end())
      context_.problems.error(end.at, fmt::format("no point is called {}", shown(end.text)),
                              meant(end.text, table, expected));
    else
      context_.problems.error(
          end.at, fmt::format("{} is in {}, not {}", shown(end.text), to_string(found->second), expected),
          "a wire goes from a coil to a discrete input");
  }

  std::string meant(std::string_view name, Table table, std::string_view expected) const {
    std::vector<std::string_view> names;
    for (const auto& [point, its_table] : tables_)
      if (its_table == table) names.push_back(point);
    std::sort(names.begin(), names.end());
    return nearest_or(name, names, fmt::format("write the name of {}", expected));
  }

  Context& context_;
  std::unordered_map<std::string_view, Table> tables_;
  std::unordered_map<std::string, Position> sources_;  ///< input -> its wire's end in the file
};

}  // namespace

std::vector<SimWire> read_sim(const Reader& top, const DraftPoints& points, Context& context) {
  std::vector<SimWire> wires;
  const Entry* entry = top.find("sim");
  if (entry == nullptr) return wires;
  if (entry->kind != Entry::Kind::list) {
    top.wrong("sim", "a list of wires");
    return wires;
  }
  SimReader reader(points, context);
  for (const Entry& wire : entry->children) {
    if (wire.kind == Entry::Kind::map)
      wires.push_back(reader.wire(wire));
    else
      context.problems.error(wire.at, fmt::format("a wire of 'sim' is a map, not {}", shown(wire)),
                             "write it as in '- {from: valve, to: valve_is_open}'");
  }
  return wires;
}

}  // namespace coupler::loader
