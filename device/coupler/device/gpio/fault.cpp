// SPDX-License-Identifier: Apache-2.0
#include "coupler/device/gpio/fault.hpp"

#include <fmt/format.h>

#include <cstring>

namespace coupler::device {

bool Fault::note(int error) {
  if (error != *error_) {
    if (error == 0)
      log_->write_limited(what_, what_ + " works again");
    else
      log_->warn_limited(
          what_,
          fmt::format(
              "{} failed: {}; requests that need it are answered with exception 04 until it works again",
              what_, std::strerror(error)));
    *error_ = error;
  }
  return error == 0;
}

void LostEdges::note(std::uint32_t count, TimePoint now) {
  if (count == 0) return;
  if (now >= quiet_from_)
    log_->warn(
        fmt::format("{}: edges came faster than they were read, at least {} lost; counters and latched "
                    "points may have missed them (the statistics count further losses)",
                    what_, count));
  quiet_from_ = now + std::chrono::seconds(1);
}

}  // namespace coupler::device
