// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/ros/ending.hpp"

#include <unistd.h>

#include <csignal>

namespace coupler::host {
namespace {

void on_signals(void (*handler)(int)) {
  std::signal(SIGINT, handler);
  std::signal(SIGTERM, handler);
}

}  // namespace

std::atomic<bool> Ending::asked{false};
std::atomic<bool> Ending::driving{false};

void Ending::at_once_on_signals() {
  on_signals([](int) { ::_exit(0); });
}

void Ending::in_order_on_signals() {
  on_signals([](int) {
    if (asked.exchange(true) && !driving) ::_exit(0);
  });
}

}  // namespace coupler::host
