// SPDX-License-Identifier: Apache-2.0
#include "coupler/map/loader/point_keys.hpp"

#include <algorithm>
#include <unordered_map>
#include <unordered_set>

#include <fmt/format.h>

#include "coupler/map/loader/nearest.hpp"

namespace coupler::loader {
namespace {

using codec::Type;

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
EdgeOf read_edge(const Reader& point, std::string_view key, DraftPoint& draft, Context& context) {
  EdgeOf edge;
  const auto reader = point.inside(key, "a map with 'of' and 'edge'");
  if (!reader) return edge;
  reader->fields(edge);
  if (const Entry* input = reader->find("of")) {
    draft.edge_at = input->at;
  } else {
    context.problems.error(point.find(key)->key_at, fmt::format("'{}' has no 'of'", key),
                           "add 'of: NAME', the discrete input whose edges count");
  }
  return edge;
}

void check_counter(const Reader& point, Type type, Context& context) {
  const Entry* counter = point.find("counter");
  if (counter == nullptr || counts(type)) return;
  context.problems.error(counter->key_at, fmt::format("'counter' does not apply to {}", to_string(type)),
                         "use UINT, UDINT or ULINT, or their signed relatives");
}

void check_latched(const Reader& reader, const Point& point, Context& context) {
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
    refuse("a latched point is cleared by a write, this one has 'access: read'", "remove 'access'");
  else if (!holds_bits(point.table) && reader.has("counter"))
    refuse("a point is a 'counter' or 'latched', not both", "remove one of the two");
}

/// What is wrong with an input, and what to do.
using Complaint = std::pair<std::string, std::string>;

class Inputs {
 public:
  Inputs(const DraftPoints& points, Span<const SimWire> sim) {
    for (const DraftPoint& draft : points) points_.emplace(draft.point.name, &draft.point);
    for (const SimWire& wire : sim) wired_.insert(wire.to);
  }

  /// Nothing if it has edges.
  std::optional<Complaint> complaint(std::string_view name) const {
    const auto found = points_.find(name);
    if (found == points_.end())
      return Complaint(fmt::format("no point is called {}", shown(name)),
                       nearest_or(name, names(), "write the name of a discrete input"));
    const Point& point = *found->second;
    if (point.table != Table::discrete_inputs)
      return Complaint(fmt::format("{} is in {}, not a discrete input", shown(name), to_string(point.table)),
                       "write the name of a discrete input");
    if (!point.line.present() && wired_.count(name) == 0)
      return Complaint(fmt::format("{} has no GPIO line, so it has no edges", shown(name)),
                       "give it a 'line', or a wire under 'sim'");
    return std::nullopt;
  }

 private:
  std::vector<std::string_view> names() const {
    std::vector<std::string_view> found;
    for (const auto& [name, point] : points_)
      if (point->table == Table::discrete_inputs) found.push_back(name);
    std::sort(found.begin(), found.end());
    return found;
  }

  std::unordered_map<std::string_view, const Point*> points_;
  std::unordered_set<std::string_view> wired_;
};

}  // namespace

void read_edges(const Reader& reader, DraftPoint& draft, Context& context) {
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

void check_edges(const DraftPoints& points, Span<const SimWire> sim, Context& context) {
  const Inputs inputs(points, sim);
  for (const DraftPoint& draft : points)
    for (const EdgeOf& edge : {draft.point.counter, draft.point.latched}) {
      if (!edge.present()) continue;
      if (auto wrong = inputs.complaint(edge.input))
        context.problems.error(draft.edge_at, std::move(wrong->first), std::move(wrong->second));
    }
}

}  // namespace coupler::loader
