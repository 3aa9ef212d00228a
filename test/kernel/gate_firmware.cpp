// SPDX-License-Identifier: Apache-2.0
// Tells each call of its hooks, and the process that they were called in.
#include <unistd.h>

#include <cstdio>
#include <thread>

#include "gate_hooks.hpp"

namespace {

void tell(const char* what, int value) {
  std::printf("%s %d in %d\n", what, value, getpid());
  std::fflush(stdout);
}

class Gate : public coupler::maps::gate::NodeHooks {
 public:
  ~Gate() override {
    if (measuring_.joinable()) measuring_.join();
  }

  bool on_motor(bool on) override {
    tell("motor", on ? 1 : 0);
    return !on || speed_ != 0;
  }

  bool on_horn(bool on) override {
    tell("horn", on ? 1 : 0);
    return true;
  }

  bool on_speed(std::int16_t speed) override {
    tell("speed", speed);
    speed_ = speed;
    return true;
  }

  void on_button(bool pressed) override {
    tell("button", pressed ? 1 : 0);
    if (!pressed) set_brake(false);
  }

  void make_safe() override { tell("safe", 0); }

  void serving_began() override {
    tell("began", 0);
    measuring_ = std::thread([this] { set_ready(true); });
  }

 private:
  std::int16_t speed_ = 0;
  std::thread measuring_;
};

}  // namespace

int main(int argc, char** argv) {
  Gate gate;
  return gate.run(argc, argv);
}
