// SPDX-License-Identifier: Apache-2.0
#include "common/cli/live_map.hpp"

namespace coupler::cli {

tl::expected<MapPtr, NoLiveMap> fetch_live_map(const Connection& /*where*/) {
  return tl::make_unexpected(NoLiveMap{failed,
                                       "this `coupler` was built without libmodbus and reaches no node",
                                       "build it where libmodbus-dev is installed, or give the map's file"});
}

}  // namespace coupler::cli
