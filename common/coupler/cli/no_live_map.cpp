// SPDX-License-Identifier: Apache-2.0
// In place of coupler/host/cli in a build without libmodbus.
#include <cstdio>

#include <fmt/format.h>

#include "coupler/cli/dump.hpp"
#include "coupler/cli/live_map.hpp"

namespace coupler::cli {
namespace {

constexpr auto what = "this `coupler` was built without libmodbus and reaches no node";
constexpr auto remedy = "build it where libmodbus-dev is installed";

}  // namespace

tl::expected<MapPtr, NoLiveMap> fetch_live_map(const Connection& /*where*/) {
  return tl::make_unexpected(NoLiveMap{failed, what, fmt::format("{}, or give the map's file", remedy)});
}

Exit dump(const Map& /*map*/, const DumpWish& /*wish*/) {
  fmt::print(stderr, "coupler dump: error: {}; {}\n", what, remedy);
  return failed;
}

}  // namespace coupler::cli
