// SPDX-License-Identifier: Apache-2.0
// A pump's controller as a Modbus node: its code is bound to the points of pump.yaml by name and type.
#include "pump_hooks.hpp"

class Pump : public coupler::maps::pump::NodeHooks {
 public:
  // Clients' writes. What is refused here, the client is told, and nothing of its request is done.
  bool on_valve(bool open) override {
    if (running_ && !open) return false;  // never against a closed valve
    open_ = open;
    return true;
  }

  bool on_run(bool on) override {
    if (on && !open_) return false;
    if (on && !running_) set_starts(++starts_);
    running_ = on;
    show();
    return true;
  }

  bool on_speed(double percent) override {
    if (percent < 10 || percent > 100) return false;
    percent_ = percent;
    show();
    return true;
  }

  // Nobody is in command any more. Clients read back what became of their outputs.
  void make_safe() override {
    running_ = false;
    set_run(false);
    show();
  }

  // Here threads of the firmware would begin that measure and call set_….
  void serving_began() override { set_temperatures({41.5F, 38.25F, 17.0F}); }

 private:
  void show() {
    set_running(running_);
    set_pressure(running_ ? percent_ * 0.06 : 0);
  }

  bool open_ = false;
  bool running_ = false;
  double percent_ = 50;
  std::uint32_t starts_ = 0;
};

int main(int argc, char** argv) {
  Pump pump;
  return pump.run(argc, argv);
}
