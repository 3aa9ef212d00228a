// SPDX-License-Identifier: Apache-2.0
#include "coupler/tools/save_map.hpp"

#include <cstdio>

#include <fmt/format.h>

#include "coupler/map/loader/load.hpp"
#include "coupler/map/node_address.hpp"
#include "coupler/map/printable.hpp"
#include "coupler/tools/output_argument.hpp"
#include "coupler/tools/place_argument.hpp"
#include "coupler/tools/report.hpp"

namespace coupler::tools {
namespace {

/// Returns the value of --at beside the saved map that means `where`. If its text has `tls`, which does not
/// count in the map that a node serves, a place without a scheme would be one with TLS.
std::string as_at(const Map& map, const Connection& where) {
  const LoadResult saved = load_map(map.text, "");
  const bool has_tls = saved.map && saved.map->map().connection.tls.present();
  return has_tls && !where.serial.present() ? node_address_text(where) : as_argument(where);
}

}  // namespace

Exit save_map(std::string_view command, const std::string& out, const Map& map, const Connection& where) {
  const std::string device = node_address_text(where);
  const bool to_file = !names_no_file(out);
  if (const Exit written = write_out(command, out, std::string(map.text)); written != ok) return written;
  fmt::print(stderr, "{}\n", summary(to_file ? out : device, map));
  if (to_file)
    fmt::print(
        stderr,
        "Next: `coupler dump {0} --at {1}` shows its values; after a change `coupler diff {2} {0}` says "
        "what it means\n",
        printable(out), printable(as_at(map, where)), printable(as_argument(where)));
  return ok;
}

}  // namespace coupler::tools
