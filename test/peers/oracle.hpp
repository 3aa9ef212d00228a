// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <modbus.h>

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "coupler/base/descriptor.hpp"

namespace coupler::oracle {

using Bytes = std::vector<std::uint8_t>;

/// The tables of the device that both sides serve: where each begins, how long it is, and what is in it at
/// the start.
struct Layout {
  int coils = 100, coils_count = 2400;
  int discrete_inputs = 50, discrete_inputs_count = 2200;
  int input_registers = 1000, input_registers_count = 300;
  int holding_registers = 2000, holding_registers_count = 400;

  static bool discrete_input(int address) { return address % 3 == 0 || address % 7 == 0; }
  static std::uint16_t input_register(int address) { return static_cast<std::uint16_t>(address * 40503); }

  /// As a map, in YAML.
  std::string map() const;
};

/// libmodbus's server: what it answers is right.
class Oracle {
 public:
  explicit Oracle(const Layout& layout);
  Bytes ask(const Bytes& request);

 private:
  std::unique_ptr<modbus_t, decltype(&modbus_free)> context_;
  std::unique_ptr<modbus_mapping_t, decltype(&modbus_mapping_free)> mapping_;
  Descriptor servers_end_;
  Descriptor our_end_;
};

/// The node, over TCP.
class Peer {
 public:
  explicit Peer(std::uint16_t port);
  bool is_connected() const { return connected_; }
  Bytes ask(const Bytes& request);

 private:
  Descriptor socket_;
  bool connected_;
};

/// Valid requests of every function that libmodbus serves too, inside the tables, across their ends and
/// outside; first every limit, then `count` random ones, the same in every run.
std::vector<Bytes> requests(const Layout& layout, int count);

}  // namespace coupler::oracle
