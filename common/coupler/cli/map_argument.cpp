// SPDX-License-Identifier: Apache-2.0
#include "coupler/cli/map_argument.hpp"

#include <utility>

#include "coupler/cli/live_map.hpp"
#include "coupler/cli/locked_map.hpp"
#include "coupler/cli/revision.hpp"

namespace coupler::cli {
namespace {

MapArgument no_map(Exit exit, const std::string& argument, std::string what, std::string remedy) {
  MapArgument none;
  none.exit = exit;
  none.loaded.diagnostics.push_back(
      {Diagnostic::Severity::error, argument, 0, 0, std::move(what), std::move(remedy)});
  return none;
}

MapArgument from_node(const std::string& argument) {
  const auto node = parse_node_address(argument);
  if (!node) return no_map(bad_call, argument, node.error().what, node.error().remedy);
  auto map = fetch_live_map(found_at({}, *node).connection);
  if (!map) return no_map(map.error().exit, argument, map.error().what, map.error().remedy);
  return {{std::move(*map), {}}, ok, *node};
}

MapArgument from_file(const std::string& path, LockUse use) {
  LoadResult loaded = use == LockUse::read ? load_map_file(path) : load_and_lock(path, use == LockUse::exact);
  const Exit exit = loaded.map ? ok : bad_input;
  return {std::move(loaded), exit, std::nullopt};
}

}  // namespace

MapArgument get_map(const std::string& argument, LockUse use) {
  return names_a_node(argument) ? from_node(argument) : from_file(argument, use);
}

MapArgument get_version(const std::string& argument) {
  if (names_a_node(argument) || !names_a_revision(argument)) return get_map(argument);
  LoadResult loaded = load_revision(argument);
  const Exit exit = loaded.map ? ok : bad_input;
  return {std::move(loaded), exit, std::nullopt};
}

}  // namespace coupler::cli
