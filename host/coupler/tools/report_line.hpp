// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include <fmt/format.h>

#include "coupler/host/core/sink.hpp"
#include "coupler/map/printable.hpp"

namespace coupler::tools {

/// "coupler panel: warning: connection lost: …", with its end of line.
inline std::string report_line(std::string_view command, host::Level level, const std::string& text) {
  const std::string_view kind = level == host::Level::info      ? ""
                                : level == host::Level::warning ? "warning: "
                                                                : "error: ";
  return fmt::format("coupler {}: {}{}\n", command, kind, printable_lines(text));
}

}  // namespace coupler::tools
