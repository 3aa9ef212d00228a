// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <csignal>

#include "coupler/device/node/io_service.hpp"

namespace coupler::device {
namespace {

using namespace std::chrono_literals;

TEST(ShutdownSummary, Of_an_idle_node_is_short) {
  EXPECT_EQ(shutdown_summary(SIGTERM, true, {}, TimePoint() + 90s),
            "Terminated: outputs are in their safe state; answered 0 requests, 0 of them with an exception; "
            "uptime 90 s");
}

TEST(ShutdownSummary, Has_every_statistic_that_is_not_0_in_one_line) {
  Statistics statistics;
  statistics.started = TimePoint() + 10s;
  statistics.requests = 1000;
  statistics.exceptions = 14;
  statistics.exceptions_of = {3, 0, 0, 11};
  statistics.hardware_errors = 1;
  statistics.events_lost = 2;
  statistics.watchdog_trips = 3;
  statistics.foreign_units = 4;
  statistics.connections = 5;
  statistics.refusals = 6;
  statistics.evictions = 7;
  statistics.bad_frames = 8;
  statistics.timeouts = 9;
  EXPECT_EQ(
      shutdown_summary(SIGINT, false, statistics, TimePoint() + 20s),
      "Interrupt: not every output could be driven to its safe state; answered 1000 requests, 14 of them "
      "with an exception (01: 3, 04: 11); uptime 10 s, connections: 5, refused: 6, evicted: 7, closed for "
      "what they sent: 8, timed out: 9, requests for other units: 4, hardware errors: 1, events lost: 2, "
      "watchdog trips: 3");
}

}  // namespace
}  // namespace coupler::device
