// SPDX-License-Identifier: Apache-2.0
// "Door opens, motor off": logic on the board, with the lines of door.yaml, that needs no client.
#include "door_hooks.hpp"

class Door : public coupler::maps::door::NodeHooks {
  void serving_began() override { on_door(get_door()); }

  // The line of the door has changed.
  void on_door(bool open) override {
    if (open) {
      if (get_motor()) set_tripped(true);
      set_motor(false);
    }
    set_alarm(open);
  }

  // A client writes the coil. It is driven after this has returned true.
  bool on_motor(bool on) override {
    if (on && get_door()) return refuse("the door is open");
    if (on) set_tripped(false);
    return true;
  }
};

int main(int argc, char** argv) { return Door().run(argc, argv); }
