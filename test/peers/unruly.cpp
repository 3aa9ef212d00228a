// SPDX-License-Identifier: Apache-2.0
// A firmware whose hooks of lines hang, throw or crash as a client tells it.
#include <unistd.h>

#include <cstdlib>
#include <stdexcept>

#include "unruly_hooks.hpp"

namespace {

class Unruly : public coupler::maps::unruly::NodeHooks {
  bool on_manners(std::uint16_t manners) override {
    manners_ = manners;
    return true;
  }
  void on_door(bool open) override {
    if (open) misbehave();
  }
  bool on_brake(bool on) override {
    if (!on) misbehave();
    return true;
  }

  void misbehave() const {
    if (manners_ == 1)
      for (;;) ::pause();
    if (manners_ == 2) throw std::runtime_error("no plan for this");
    if (manners_ == 3) std::abort();
  }

  std::uint16_t manners_ = 0;
};

}  // namespace

int main(int argc, char** argv) { return Unruly().run(argc, argv); }
