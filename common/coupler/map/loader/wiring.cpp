// SPDX-License-Identifier: Apache-2.0
// Keys that join points: `sim:`, `counter:` and `latched:`.
#include <unordered_map>
#include <unordered_set>

#include <fmt/format.h>

#include "coupler/map/loader/map_reader.hpp"
#include "coupler/map/loader/point_names.hpp"
#include "coupler/map/loader/point_reader.hpp"

namespace coupler::loader {
namespace {

using codec::Type;

class SimReader {
 public:
  SimReader(const DraftPoints& points, const Context& context) : context_(context), names_(points) {}

  SimWire wire(const Entry& entry) {
    const Reader reader(entry, Section::wire, context_);
    SimWire wire;
    reader.fields(wire);
    check_source(reader, entry);
    if (const Entry* to = reader.find("to"))
      check_input(*to);
    else if (reader.lacks("to"))
      context_.problems.error(entry.at, "the wire has no 'to'",
                              "add 'to: NAME', the discrete input at its end");
    return wire;
  }

 private:
  void check_source(const Reader& reader, const Entry& wire) {
    const Entry* from = reader.find("from");
    if ((from != nullptr) == reader.has("square"))
      context_.problems.error(
          wire.at, "the wire needs either 'from' or 'square'",
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
    names_.find(end.text, table, end.at, "a wire goes from a coil to a discrete input", context_);
  }

  const Context& context_;
  PointNames names_;
  std::unordered_map<std::string, Position> sources_;  ///< input -> its wire's end in the file
};

bool counts(Type type) {
  switch (type) {
    case Type::INT:
    case Type::UINT:
    case Type::DINT:
    case Type::UDINT:
    case Type::LINT:
    case Type::ULINT: return true;
    default: return false;
  }
}

/// Nothing if the key is absent or wrong.
EdgeOf read_edge(const Reader& point, std::string_view key, DraftPoint& draft, const Context& context) {
  EdgeOf edge;
  const auto reader = point.inside(key, "a map with 'of' and 'edge'");
  if (!reader) return edge;
  reader->fields(edge);
  if (const Entry* input = reader->find("of")) {
    draft.edge_at = input->at;
  } else if (reader->lacks("of")) {
    context.problems.error(point.find(key)->key_at, fmt::format("'{}' has no 'of'", key),
                           "add 'of: NAME', the discrete input whose edges count");
  }
  return edge;
}

void check_counter(const Reader& point, Type type, const Context& context) {
  const Entry* counter = point.find("counter");
  if (counter == nullptr || counts(type)) return;
  context.problems.error(counter->key_at, fmt::format("'counter' does not apply to {}", to_string(type)),
                         "use INT, DINT, LINT, UINT, UDINT or ULINT");
}

void check_latched(const Reader& reader, const Point& point, const Context& context) {
  const Entry* latched = reader.find("latched");
  if (latched == nullptr) return;
  const auto refuse = [&](std::string what, std::string remedy) {
    context.problems.error(latched->key_at, std::move(what), std::move(remedy));
  };
  if (point.format.type != Type::BOOL)
    refuse(fmt::format("'latched' does not apply to {}", to_string(point.format.type)),
           "use 'type: BOOL' with 'bit', or a coil");
  else if (point.line.present())
    refuse("a latched coil has no GPIO line of its own",
           "remove 'line', and name in 'of' the input that has the line");
  else if (!is_writable(point))
    refuse("a latched point is cleared by a write, but this one has 'access: read'", "remove 'access'");
  else if (!holds_bits(point.table) && reader.has("counter"))
    refuse("a point is a 'counter' or 'latched', not both", "remove one of the two");
}

}  // namespace

std::vector<SimWire> read_sim(const Reader& top, const DraftPoints& points, const Context& context) {
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
      context.problems.error(wire.at, fmt::format("a wire of 'sim' must be a map, not {}", shown(wire)),
                             "write it as in '- {from: valve, to: valve_is_open}'");
  }
  return wires;
}

void read_edges(const Reader& reader, DraftPoint& draft, const Context& context) {
  Point& point = draft.point;
  if (!holds_bits(point.table)) {
    point.counter = read_edge(reader, "counter", draft, context);
    if (draft.placed) check_counter(reader, point.format.type, context);
  }
  if (is_writable(point.table)) {
    point.latched = read_edge(reader, "latched", draft, context);
    if (draft.placed) check_latched(reader, point, context);
  }
}

void check_edges(const DraftPoints& points, Span<const SimWire> sim, const Context& context) {
  const PointNames names(points);
  std::unordered_set<std::string_view> wired;
  for (const SimWire& wire : sim) wired.insert(wire.to);
  for (const DraftPoint& draft : points)
    for (const EdgeOf& edge : {draft.point.counter, draft.point.latched}) {
      if (!edge.present()) continue;
      const Point* input = names.find(edge.input, Table::discrete_inputs, draft.edge_at,
                                      "write the name of a discrete input", context);
      if (input == nullptr || input->line.present() || wired.count(edge.input) > 0) continue;
      context.problems.error(draft.edge_at,
                             fmt::format("{} has no GPIO line, so it has no edges", shown(edge.input)),
                             "give it a 'line', or a wire under 'sim'");
    }
}

}  // namespace coupler::loader
