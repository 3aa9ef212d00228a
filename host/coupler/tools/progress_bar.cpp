// SPDX-License-Identifier: Apache-2.0
#include "coupler/tools/progress_bar.hpp"

#include <unistd.h>

#include <cstdio>

#include <fmt/format.h>

namespace coupler::tools {
namespace {

constexpr std::uint32_t bar_width = 24;
constexpr std::chrono::milliseconds frame{100};
constexpr auto clear_line = "\r\x1B[K";

}  // namespace

ProgressBar::ProgressBar() : is_terminal_(::isatty(STDERR_FILENO) == 1) {}

ProgressBar::~ProgressBar() {
  if (is_terminal_) std::fputs(clear_line, stderr);
}

void ProgressBar::begins(std::string_view step) {
  step_ = where_.empty() ? std::string(step) : fmt::format("{} {}", step, where_);
  if (is_terminal_)
    moved(0, 1, 0);
  else
    fmt::print(stderr, "looking at {}\n", step_);
}

void ProgressBar::moved(std::uint32_t done, std::uint32_t total, std::uint64_t requests) {
  const auto now = std::chrono::steady_clock::now();
  if (!is_terminal_ || (done < total && requests > 0 && now - drawn_ < frame)) return;
  drawn_ = now;
  const std::uint32_t filled = total == 0 ? bar_width : done * bar_width / total;
  fmt::print(stderr, "{}[{:#<{}}{:.<{}}] {}", clear_line, "", filled, "", bar_width - filled, step_);
  if (requests > 0) fmt::print(stderr, ", requests so far: {}", requests);
  std::fflush(stderr);
}

}  // namespace coupler::tools
