// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/prctl.h>
#include <unistd.h>

#include <csignal>
#include <string>

#include "coupler/device/net/signals.hpp"
#include "coupler/device/node/reload_requests.hpp"
#include "coupler/device/supervisor/child.hpp"

namespace coupler::device {
namespace {

/// A process with the node's name that answers one SIGHUP.
Child node_that_answers(bool taken) {
  auto child = Child::start([taken] {
    Loop loop;
    Signals signals(loop);
    ::prctl(PR_SET_NAME, "coupler-node");
    ReloadRequests requests;
    for (;;) {
      loop.run_once(std::nullopt);
      const auto asker = signals.take_reload();
      if (!asker) continue;
      requests.add(*asker);
      requests.reply(taken, taken ? "read the map again" : "the new map is refused");
    }
    return 0;
  });
  return *std::move(child);
}

int ask(const Child& node) {
  StderrLog log(nullptr);
  // Before it has its name and handles the signal it is another program.
  for (;;)
    if (const int status = ask_to_reload(node.pid(), log); status != 3) return status;
}

TEST(Reload, Who_asks_hears_how_it_ended) {
  testing::internal::CaptureStderr();
  EXPECT_EQ(ask(node_that_answers(true)), 0);
  EXPECT_THAT(testing::internal::GetCapturedStderr(),
              testing::EndsWith("coupler-node: read the map again\n"));
  EXPECT_EQ(ask(node_that_answers(false)), 1);
}

TEST(Reload, Another_program_is_not_sent_a_signal) {
  auto other = *Child::start([] {
    for (;;) ::pause();
    return 0;
  });
  StderrLog log(nullptr);
  EXPECT_EQ(ask_to_reload(other.pid(), log), 3);
  EXPECT_FALSE(other.wait(std::chrono::milliseconds(0))) << "it has ended";
}

}  // namespace
}  // namespace coupler::device
