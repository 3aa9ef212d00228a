// SPDX-License-Identifier: Apache-2.0
// A node without an operating system: what a port has instead of coupler/device/net, coupler/device/gpio and
// coupler/device/node. It takes one request from a static buffer and writes the reply to the debugger's
// console. Everything that it uses is in static memory.
#include <algorithm>
#include <cstddef>
#include <iterator>

#include "coupler/modbus/frame.hpp"
#include "example_core.hpp"

namespace coupler::device {
namespace {

/// A debugger's service (Arm semihosting), which QEMU offers too.
void ask_debugger(int operation, const void* argument) {
  register int r0 asm("r0") = operation;
  register const void* r1 asm("r1") = argument;
  asm volatile("bkpt 0xab" : "+r"(r0) : "r"(r1) : "memory");
}

void print(const char* text) {
  constexpr int write_text = 0x04;
  ask_debugger(write_text, text);
}

[[noreturn]] void stop(std::uintptr_t reason) {
  constexpr int exit = 0x18;
  ask_debugger(exit, reinterpret_cast<const void*>(reason));
  for (;;) {
  }
}

[[noreturn]] void stop_well() { stop(0x20026); }  // ADP_Stopped_ApplicationExit

[[noreturn]] void fail(const char* why) {
  print(why);
  print("\n");
  stop(0x20023);  // ADP_Stopped_RunTimeErrorUnknown
}

void print_hex(Span<const std::uint8_t> bytes) {
  if (bytes.empty()) return;
  static char text[4 * modbus::max_adu_size + 2];
  char* end = text;
  for (const std::uint8_t byte : bytes) {
    *end++ = "0123456789abcdef"[byte >> 4];
    *end++ = "0123456789abcdef"[byte & 15];
  }
  *end++ = '\n';
  *end = '\0';
  print(text);
}

/// Port registers of a chip, as far as the example's three inputs and outputs need them.
class Ports final : public Lines {
 public:
  bool read(modbus::Range inputs, Span<std::uint16_t> levels, TimePoint) override {
    for (std::size_t i = 0; i < levels.size(); ++i) levels[i] = in_ >> (inputs.start() + i) & 1;
    return true;
  }
  bool drive(modbus::Range coils, Span<const std::uint16_t> levels) override {
    for (std::size_t i = 0; i < levels.size(); ++i) {
      const std::uint32_t bit = 1U << (coils.start() + i);
      out_ = levels[i] != 0 ? out_ | bit : out_ & ~bit;
    }
    return true;
  }
  bool driven(modbus::Range coils, Span<std::uint16_t> levels) const override {
    for (std::size_t i = 0; i < levels.size(); ++i)
      if (coils.start() + i < wired_outputs) levels[i] = out_ >> (coils.start() + i) & 1;
    return coils.start() < wired_outputs;
  }
  bool drive_safe() override {
    out_ = 0b010;
    return true;
  }

 private:
  static constexpr std::uint32_t wired_outputs = 3;
  volatile std::uint32_t in_ = 0b101;
  volatile std::uint32_t out_ = 0b010;  // the lamp is on at start, and in its safe state
};

/// Has code behind two points.
class Firmware final : public maps::example::NodeCore {
 public:
  using NodeCore::NodeCore;

 private:
  bool on_speed(std::int16_t speed) override {
    return speed <= 1000 && set_revision(static_cast<std::uint16_t>(speed));
  }
  bool on_label(std::string_view label) override { return label != "root"; }
};

std::uint8_t reply[2 * modbus::max_adu_size];

/// The replies to a client's first requests, one after the other, and what it hears a millisecond later.
void answer_all() {
  constexpr std::uint8_t requests[][33] = {
      {0, 1, 0, 0, 0, 6, 1, 2, 0, 0, 0, 3},        // the three inputs
      {0, 2, 0, 0, 0, 6, 1, 5, 0, 0, 0xFF, 0},     // relay on
      {0, 3, 0, 0, 0, 6, 1, 1, 0, 0, 0, 4},        // the coils
      {0, 4, 0, 0, 0, 6, 1, 3, 0, 0, 0, 3},        // speed and ratio
      {0, 5, 0, 0, 0, 6, 1, 4, 0xFF, 0, 0, 3},     // the identity area: "OCPL", layout 1
      {0, 6, 0, 0, 0, 6, 1, 3, 0x12, 0x34, 0, 1},  // an address that is not mapped
      {0, 7, 0, 0, 0, 6, 1, 4, 0xFF, 0x2D, 0,
       8},  // which machine it is: how many registers, serial, "board-"
      {0, 8, 0, 0, 0, 6, 1, 6, 0, 0, 0x01, 0xF4},   // speed 500, which the firmware takes …
      {0, 9, 0, 0, 0, 6, 1, 4, 0, 0, 0, 1},         // … and shows as the revision
      {0, 10, 0, 0, 0, 6, 1, 6, 0, 0, 0x07, 0xD0},  // speed 2000, which it refuses
      {0, 11, 0, 0, 0, 11, 1, 16, 0, 5, 0, 2, 4, 'r', 'o', 'o', 't'},  // "root" and what was there: "rootmed"
      {0, 12, 0, 0, 0, 17, 1, 65, 1, 0x75, 0x30, 0, 0, 0, 7},          // changes since the start: the relay
      {0, 13, 0, 0, 0, 17, 1, 65, 1, 0x75, 0x30, 0,
       0, 0,  7, 0, 0, 0,  0, 0,  0, 0,    1},  // and since then: waits …
      {0, 14, 0, 0, 0, 6, 1, 5, 0, 0, 0, 0},  // … for relay off, but is answered before what comes behind it
      {0, 15, 0,    0,    0,    27, 1, 66, 1, 1, 0, 0, 0, 7, 0, 0, 0,
       0, 0,  0x0F, 0x42, 0x40, 0,  0, 0,  0, 1, 0, 0, 0, 1, 1, 1},  // the relay, to be on after 1,000,000 ns
      {0, 16, 0,    0,    0,    27, 1, 66, 1, 1, 0, 0, 0, 7, 0, 0, 0,
       0, 0,  0x1E, 0x84, 0x80, 0,  0, 0,  0, 1, 0, 0, 0, 1, 1, 0},  // and off after 2,000,000 …
      {0, 17, 0, 0, 0, 10, 1, 66, 1, 2, 0, 0, 0, 7, 0, 2},           // … which is cancelled
      {0, 18, 0, 0, 0, 17, 1, 65, 1, 0x75, 0x30, 0, 0, 0, 7, 0, 0, 0, 0, 0, 0, 0, 2},  // relay off is known
      {0, 19, 0, 0, 0, 17, 1, 65, 1, 0x75, 0x30, 0,
       0, 0,  7, 0, 0, 0,  0, 0,  0, 0,    3},  // the cancelled one too
  };
  constexpr TimePoint later{std::chrono::milliseconds(1)};
  Ports ports;
  static Firmware node(ports);
  // Of a chip: its unique number, hashed, and a name that somebody gave it.
  node.handler().set_machine(identity::machine_of("board-1", 0x0011223344556677));
  node.handler().tell_changes(7, TimePoint{});
  static modbus::Framer framer;
  ClientSession client;
  for (const auto& request : requests) {
    const std::size_t size = 6 + request[5];  // by its header
    std::copy_n(request, size, framer.room().begin());
    framer.filled(size);
    if (framer.next() != modbus::Framer::Outcome::frame) fail("the framer finds no frame");
    print_hex({reply, node.server().answer(framer.frame(), client, TimePoint{}, reply)});
    print_hex({reply, node.server().answer_waiting(client, TimePoint{}, reply)});
  }
  node.handler().tick(later);
  print_hex({reply, node.server().answer_waiting(client, later, reply)});
}

}  // namespace
}  // namespace coupler::device

// What the linker wants of every port: the entry, where a failed assertion ends, the list of static objects
// to be destroyed at an end that never comes, and the deallocation that the table of a virtual destructor
// names and nobody calls.
extern "C" void start() {
  coupler::device::answer_all();
  coupler::device::stop_well();
}
extern "C" int __aeabi_atexit(void*, void (*)(void*), void*) { return 0; }
void* __dso_handle = nullptr;
extern "C" void __assert_func(const char*, int, const char*, const char* what) {
  coupler::device::fail(what);
}
/// What the chip reads at reset: the stack, and where to begin.
extern "C" const std::uint8_t stack_top[];
[[gnu::section(".vectors"), gnu::used]] const void* const vectors[] = {stack_top,
                                                                       reinterpret_cast<const void*>(start)};

void operator delete(void*) noexcept { coupler::device::fail("something was deallocated"); }
void operator delete(void*, std::size_t) noexcept { coupler::device::fail("something was deallocated"); }
