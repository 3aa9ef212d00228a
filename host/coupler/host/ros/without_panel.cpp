// SPDX-License-Identifier: Apache-2.0
// For a build without cpp-httplib.
#include "coupler/host/ros/device_panel.hpp"

namespace coupler::host {

std::unique_ptr<Follower> start_panel(const Map& /*map*/, const ValueTable& /*table*/, unsigned /*port*/,
                                      const std::function<void(Level, const std::string&)>& report) {
  report(
      Level::error,
      "this driver was built without cpp-httplib, so there is no panel: apt install libcpp-httplib-dev and "
      "build it again");
  return nullptr;
}

}  // namespace coupler::host
