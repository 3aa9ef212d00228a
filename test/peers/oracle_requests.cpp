// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <initializer_list>
#include <random>

#include "coupler/modbus/limits.hpp"
#include "test/peers/oracle.hpp"

namespace coupler::oracle {
namespace {

class Builder {
 public:
  explicit Builder(const Layout& layout) : layout_(layout) {}

  std::vector<Bytes> finish() { return std::move(requests_); }

  /// A request of each function for that start (relative to its table) and quantity, as far as the function
  /// takes it.
  void each_function(int start, int quantity) {
    if (quantity <= modbus::max_read_bits) {
      add(1, {layout_.coils + start, quantity});
      add(2, {layout_.discrete_inputs + start, quantity});
    }
    if (quantity <= modbus::max_read_registers) {
      add(3, {layout_.holding_registers + start, quantity});
      add(4, {layout_.input_registers + start, quantity});
    }
    if (quantity <= modbus::max_write_bits)
      add(15, {layout_.coils + start, quantity}, counted((quantity + 7) / 8));
    if (quantity <= modbus::max_write_registers)
      add(16, {layout_.holding_registers + start, quantity}, counted(2 * quantity));
    if (quantity <= modbus::max_read_write_registers)
      add(23, {layout_.holding_registers + start, quantity, layout_.holding_registers + start / 2, quantity},
          counted(2 * quantity));
  }

  void each_single_write(int start) {
    add(5, {layout_.coils + start, 0xFF00});
    add(1, {layout_.coils, 16});
    add(5, {layout_.coils + start, 0x0000});
    add(6, {layout_.holding_registers + start, number(0, 0xFFFF)});
    add(22, {layout_.holding_registers + start, number(0, 0xFFFF), number(0, 0xFFFF)});
    add(3, {layout_.holding_registers, 8});
  }

  int number(int from, int to) { return std::uniform_int_distribution<int>(from, to)(random_); }

 private:
  void add(int function, std::initializer_list<int> fields, const Bytes& rest = {}) {
    Bytes pdu{static_cast<std::uint8_t>(function)};
    for (const int field : fields) {
      pdu.push_back(static_cast<std::uint8_t>(field >> 8));
      pdu.push_back(static_cast<std::uint8_t>(field));
    }
    pdu.insert(pdu.end(), rest.begin(), rest.end());
    const auto length = static_cast<std::uint8_t>(pdu.size() + 1);
    const auto id = static_cast<std::uint16_t>(requests_.size());
    Bytes adu{static_cast<std::uint8_t>(id >> 8), static_cast<std::uint8_t>(id), 0, 0, 0, length, 1};
    adu.insert(adu.end(), pdu.begin(), pdu.end());
    requests_.push_back(std::move(adu));
  }

  Bytes counted(int bytes) {
    Bytes data{static_cast<std::uint8_t>(bytes)};
    for (int i = 0; i < bytes; ++i) data.push_back(static_cast<std::uint8_t>(number(0, 255)));
    return data;
  }

  const Layout& layout_;
  std::vector<Bytes> requests_;
  std::mt19937 random_{20211211};
};

}  // namespace

std::vector<Bytes> requests(const Layout& layout, int count) {
  Builder builder(layout);
  for (const int quantity :
       {1, 2, 7, 8, 9, 16, 17, 120, 121, 122, 123, 124, 125, 1967, 1968, 1969, 1999, 2000})
    for (const int start : {0,   1,   5,    175,  176,  177,  275, 276, 279,   283,   299,  300,
                            399, 400, 2199, 2200, 2399, 2400, -1,  -50, 60000, 63500, 64480})
      builder.each_function(start, quantity);
  for (const int start : {0, 7, 299, 300, 399, 400, 2399, 2400, -1}) builder.each_single_write(start);
  for (int i = 0; i < count; ++i) {
    const int longest = builder.number(0, 3) == 0 ? 2000 : 125;
    builder.each_function(builder.number(-20, longest == 2000 ? 2500 : 420), builder.number(1, longest));
    builder.each_single_write(builder.number(-2, 410));
  }
  return builder.finish();
}

}  // namespace coupler::oracle
