// SPDX-License-Identifier: Apache-2.0
#include "coupler/device/node/serve_error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>

namespace coupler::device {

void log_errors(Log& log, const ServeError& error) {
  for (std::string_view errors = error.errors; !errors.empty();) {
    const auto end = std::min(errors.find('\n'), errors.size());
    log.fail(fmt::format("error: {}", errors.substr(0, end)));
    errors.remove_prefix(std::min(end + 1, errors.size()));
  }
}

}  // namespace coupler::device
