// SPDX-License-Identifier: Apache-2.0
// The node of board.yaml on lwIP's Unix port, as a stand-in for a chip: `lwip_node` has the address 192.0.2.2
// on the tap interface that PRECONFIGURED_TAPIF names. On a chip its own start-up code, network interface and
// pins take the place of main() and Pins; Board and lwip_server.* stay.
#include <lwip/netif.h>
#include <lwip/tcpip.h>
#include <lwip/timeouts.h>
#include <sys/random.h>
#include <unistd.h>
extern "C" {
#include <netif/tapif.h>
}

#include <cstdio>
#include <ctime>

#include "board_core.hpp"
#include "lwip_server.hpp"

namespace {

using coupler::Span;
using coupler::device::TimePoint;
using coupler::modbus::Range;

/// A port register for each direction. The relay's contact is wired to the button.
class Pins final : public coupler::device::Lines {
 public:
  bool read(Range, Span<std::uint16_t> levels, TimePoint) override {
    levels[0] = relay_;
    return true;
  }
  /// A pin that is looked at. An interrupt's edges have times of their own.
  void take_edges(TimePoint now, coupler::device::EdgeSink& sink) override {
    sink.changed(0, relay_ != 0, now);
  }
  bool drive(Range, Span<const std::uint16_t> levels) override {
    relay_ = levels[0];
    return true;
  }
  bool driven(Range, Span<std::uint16_t> levels) const override {
    levels[0] = relay_;
    return true;
  }
  bool drive_safe() override {
    relay_ = 0;
    return true;
  }

 private:
  std::uint16_t relay_ = 0;
};

/// The firmware: what is behind the points that have no pin.
class Board : public coupler::maps::board::NodeCore {
 public:
  using NodeCore::NodeCore;

 private:
  bool on_set_point(double celsius) override {
    if (celsius < 5 || celsius > 40) return false;
    set_temperature(celsius);  // a very fast oven
    set_writes(++writes_);
    return true;
  }

  std::uint32_t writes_ = 0;
};

Pins pins;
Board board(pins);
LwipServer server(board.server(), board.statistics());

/// The output watchdog, and changes for who waits for them.
void tick(void*) {
  board.handler().tick(lwip_now());
  server.answer_waiting();
  sys_timeout(20, tick, nullptr);
}

/// On a chip from its source of random numbers, or from a counter of its starts.
std::uint32_t new_epoch() {
  std::uint32_t epoch = 0;
  if (getrandom(&epoch, sizeof epoch, 0) != sizeof epoch)
    epoch = static_cast<std::uint32_t>(std::time(nullptr));
  return epoch != 0 ? epoch : 1;
}

void start(void*) {
  static netif interface;
  ip4_addr_t address, mask, gateway;
  IP4_ADDR(&address, 192, 0, 2, 2);
  IP4_ADDR(&mask, 255, 255, 255, 0);
  IP4_ADDR(&gateway, 192, 0, 2, 1);
  netif_add(&interface, &address, &mask, &gateway, nullptr, tapif_init, tcpip_input);
  netif_set_default(&interface);
  netif_set_up(&interface);
  // On a chip: its name, and a hash of its unique number.
  board.handler().set_machine(coupler::identity::machine_of("board-1", 0x0011223344556677));
  board.handler().tell_changes(new_epoch(), lwip_now());
  const bool listens = server.listen(502);
  std::puts(listens ? "lwip_node: serving on 192.0.2.2:502" : "lwip_node: cannot listen on port 502");
  std::fflush(stdout);
  tick(nullptr);
}

}  // namespace

int main() {
  tcpip_init(start, nullptr);
  for (;;) pause();
}
