// SPDX-License-Identifier: Apache-2.0
// Both sides of tank.yaml in one program: `tank` is the node, `tank fill PERCENT` its client.
#include <cstdio>
#include <cstdlib>
#include <string>

#include "tank_client.hpp"
#include "tank_hooks.hpp"

using namespace std::chrono_literals;

class Tank : public coupler::maps::tank::NodeHooks {
  // A write is acknowledged if its hook returns true.
  bool on_target(std::uint16_t percent) override {
    target_ = percent;
    return percent <= 100;
  }
  bool on_pump(bool on) override {
    if (on) set_level(target_);  // a very fast pump
    return true;
  }

  std::uint16_t target_ = 50;
};

int fill(const char* percent) {
  coupler::maps::tank::Client tank;
  tank.connect();
  if (!tank.wait_online(10s)) return 3;
  for (const coupler::client::SetResult& result :
       {tank.target.set(static_cast<std::uint16_t>(std::atoi(percent))).get(), tank.pump.set(true).get()})
    if (!result) {
      std::fprintf(stderr, "tank: %s\n", result.text.c_str());
      return 1;
    }
  for (int tries = 0; tries < 100; ++tries) {
    const auto level = tank.level.wait(10s);
    if (level && level->value == std::atoi(percent)) {
      std::printf("%g %%\n", level->value);
      return 0;
    }
    std::this_thread::sleep_for(50ms);
  }
  return 3;
}

int main(int argc, char** argv) {
  if (argc == 3 && argv[1] == std::string("fill")) return fill(argv[2]);
  return Tank().run(argc, argv);
}
