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

}  // namespace coupler::device
