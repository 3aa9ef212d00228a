// SPDX-License-Identifier: Apache-2.0
#include "coupler/tools/save_map.hpp"

#include <cstdio>

#include <fmt/format.h>

#include "coupler/map/node_address.hpp"
#include "coupler/map/printable.hpp"
#include "coupler/tools/output_argument.hpp"
#include "coupler/tools/place_argument.hpp"
#include "coupler/tools/report.hpp"

namespace coupler::tools {

Exit save_map(std::string_view command, const std::string& out, const Map& map, const Connection& where) {
  const std::string device = node_address_text(where);
  const bool to_file = !names_no_file(out);
  if (const Exit written = write_out(command, out, std::string(map.text)); written != ok) return written;
  fmt::print(stderr, "{}\n", summary(to_file ? out : device, map));
  if (to_file)
    fmt::print(
        stderr,
        "Next: `coupler dump {0} --at {1}` shows its values; after a change `coupler diff {1} {0}` says "
        "what it means\n",
        printable(out), printable(as_argument(where)));
  return ok;
}

}  // namespace coupler::tools
