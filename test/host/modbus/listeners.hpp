// SPDX-License-Identifier: Apache-2.0
// Who is told what a device does, in tests of writes.
#pragma once

#include <atomic>
#include <string>

#include "coupler/host/core/sink.hpp"
#include "coupler/host/core/write.hpp"

namespace coupler::host {

/// Hears nothing.
struct DeafSink : Sink {
  void on_values(Span<const std::uint32_t>) override {}
  void on_online(bool) override {}
  void on_report(Level, const std::string&) override {}
};

/// Knows when the device is online.
struct OnlineSink : DeafSink {
  std::atomic<bool> is_online{false};
  void on_online(bool online) override { is_online = online; }
};

/// Counts results from any thread.
struct Tally : WriteListener {
  std::atomic<int> all{0};
  std::atomic<int> ok{0};
  void on_result(const WriteResult& result) override {
    if (result.outcome == WriteResult::Outcome::ok) ++ok;
    ++all;
  }
};

}  // namespace coupler::host
