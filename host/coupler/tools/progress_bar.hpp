// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <chrono>
#include <string>

#include "coupler/host/scan/ports.hpp"

namespace coupler::tools {

/// Shows on standard error how far a scan is: a bar on a terminal, otherwise a line for each step.
class ProgressBar : public scan::ScanProgress {
 public:
  ProgressBar();
  ~ProgressBar() override;
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;

  void begins(std::string_view step) override;
  void moved(std::uint32_t done, std::uint32_t total, std::uint64_t requests) override;
  bool wants_end() const override { return ended_; }

  /// Said with each step from now on, as "at 9600 8N1".
  void where(std::string_view text) { where_ = text; }

  /// From any thread.
  void end() { ended_ = true; }

 private:
  bool is_terminal_;
  std::string step_;
  std::string where_;
  std::chrono::steady_clock::time_point drawn_{};
  std::atomic<bool> ended_{false};
};

}  // namespace coupler::tools
