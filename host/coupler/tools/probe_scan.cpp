// SPDX-License-Identifier: Apache-2.0
#include "coupler/tools/probe_scan.hpp"

#include <unistd.h>

#include <atomic>
#include <chrono>
#include <cstddef>
#include <cstdio>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "coupler/host/core/clock.hpp"
#include "coupler/map/fields.hpp"
#include "coupler/tools/interruption.hpp"
#include "coupler/tools/modbus_client.hpp"

namespace coupler::tools {
namespace {

constexpr std::uint32_t bar_width = 24;
constexpr std::chrono::milliseconds frame{100};
constexpr auto clear_line = "\r\x1B[K";

/// Shows on standard error how far a scan is: a bar on a terminal, otherwise a line for each step.
class ProgressBar : public scan::ScanProgress {
 public:
  ProgressBar() : is_terminal_(::isatty(STDERR_FILENO) == 1) {}
  ~ProgressBar() override {
    if (is_terminal_) std::fputs(clear_line, stderr);
  }
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;

  void begins(std::string_view step) override {
    step_ = where_.empty() ? std::string(step) : fmt::format("{} {}", step, where_);
    if (is_terminal_)
      draw(0, 1, 0);
    else
      fmt::print(stderr, "looking at {}\n", step_);
  }

  void moved(std::uint32_t done, std::uint32_t total, std::uint64_t requests) override {
    const bool is_due = done >= total || requests == 0 || std::chrono::steady_clock::now() - drawn_ >= frame;
    if (is_terminal_ && is_due) draw(done, total, requests);
  }

  bool wants_end() const override { return ended_; }

  /// Said with each step from now on, as "at 9600 8N1".
  void where(std::string_view text) { where_ = text; }

  /// From any thread.
  void end() { ended_ = true; }

 private:
  void draw(std::uint32_t done, std::uint32_t total, std::uint64_t requests) {
    drawn_ = std::chrono::steady_clock::now();
    const std::uint32_t filled = total == 0 ? bar_width : done * bar_width / total;
    fmt::print(stderr, "{}[{:#<{}}{:.<{}}] {}", clear_line, "", filled, "", bar_width - filled, step_);
    if (requests > 0) fmt::print(stderr, ", requests so far: {}", requests);
    std::fflush(stderr);
  }

  bool is_terminal_;
  std::string step_;
  std::string where_;
  std::chrono::steady_clock::time_point drawn_{};
  std::atomic<bool> ended_{false};
};

scan::Findings look(ProbeCall& call, ProgressBar& progress) {
  ModbusClient client(call.connection);
  host::SteadyClock clock;
  const Interruption interruption([&] {
    progress.end();
    clock.stop();
    client.interrupt();
  });
  scan::Findings findings = scan::scan(call.task, client, clock, progress);
  call.ended_by = interruption.signal();
  return findings;
}

}  // namespace

scan::Findings look_at_each_line(ProbeCall& call) {
  ProgressBar progress;
  scan::Findings findings;
  bool is_asked = false;
  for (std::size_t i = 0; i < call.lines.size(); ++i) {
    const Serial& line = call.lines[i];
    call.connection.serial = line;
    if (line.present())
      progress.where(
          fmt::format("at {}{}", rate_and_parity(line),
                      call.lines.size() > 1 ? fmt::format(" ({} of {})", i + 1, call.lines.size()) : ""));
    scan::Findings found = look(call, progress);
    const bool is_refused = found.broke_off && found.requests == 0;  // perhaps not the next one
    if (!is_refused || !is_asked) findings = std::move(found);
    is_asked |= !is_refused;
    if (findings.unit || (findings.broke_off && !is_refused) || progress.wants_end()) break;
  }
  return findings;
}

Failure why_unreachable(const host::Error& error, const Connection& connection) {
  return {failed, host::to_string(error),
          reach_remedy(connection, error,
                       "check that the device is on, that the port is right, and that no other client holds "
                       "its last connection")};
}

Failure why_no_unit(const ProbeCall& call) {
  const std::size_t units = call.task.units.size();
  if (!call.connection.is_rtu())
    return {failed, fmt::format("a server accepts connections, but none of {} units answers", units),
            "give its unit id, as HOST/17, or try all with --units 0-247,255"};
  return {
      failed, fmt::format("none of {} units answers on this line", units),
      call.connection.serial.present()
          ? "check A and B, the power, and the module's rate and parity: --baud and --parity say what is "
            "tried"
          : "check A and B, the power, and the gateway's rate and parity; if it translates, give its address "
            "without rtu+"};
}

}  // namespace coupler::tools
