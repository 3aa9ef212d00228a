// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <deque>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "common/map/identity.hpp"
#include "host/core/transport.hpp"

namespace coupler::driver::test {

/// A Modbus device without a network: four tables, a list of what was asked, and the failures a test plans.
class FakeDevice : public Transport {
 public:
  std::map<std::pair<Table, std::uint32_t>, std::uint16_t> values;  ///< what is not in it reads as 0
  std::set<std::pair<Table, std::uint32_t>> missing;                ///< asked for: exception 02
  std::vector<std::string> requests;  ///< "read coils 0+3", "write register 5" …
  std::optional<Error> refuse_connect;
  std::deque<Error> next_errors;  ///< each for one request, before it does anything
  std::string file;               ///< what FC 20 gives
  bool connected = false;

  /// The device is a node that serves `map`.
  void serve(const Map& map) {
    file = map.text;
    std::array<std::uint16_t, identity::head_size> area{};
    identity::write_head(identity::head_of(map), area.data());
    for (std::uint32_t i = 0; i < area.size(); ++i)
      values[{Table::input_registers, identity::reserved.start() + i}] = area[i];
  }

  std::size_t count(const std::string& request) const {
    return static_cast<std::size_t>(std::count(requests.begin(), requests.end(), request));
  }

  Result<> connect() override {
    requests.emplace_back("connect");
    if (refuse_connect) return tl::make_unexpected(*refuse_connect);
    connected = true;
    return {};
  }
  void close() override { connected = false; }
  void interrupt() override {}

  Result<> read_bits(Table table, modbus::Range range, std::uint8_t* bits) override {
    return read(table, range, [&](std::uint32_t i, std::uint16_t value) { bits[i] = value != 0 ? 1 : 0; });
  }
  Result<> read_registers(Table table, modbus::Range range, std::uint16_t* registers) override {
    return read(table, range, [&](std::uint32_t i, std::uint16_t value) { registers[i] = value; });
  }
  Result<> write_coil(std::uint16_t address, bool on) override {
    return write("coil", Table::coils, address, {static_cast<std::uint16_t>(on ? 1 : 0)});
  }
  Result<> write_register(std::uint16_t address, std::uint16_t value) override {
    return write("register", Table::holding_registers, address, {value});
  }
  Result<> write_coils(std::uint16_t address, Span<const std::uint8_t> bits) override {
    return write("coils", Table::coils, address, {bits.begin(), bits.end()});
  }
  Result<> write_registers(std::uint16_t address, Span<const std::uint16_t> registers) override {
    return write("registers", Table::holding_registers, address, {registers.begin(), registers.end()});
  }
  Result<> mask_write(std::uint16_t address, std::uint16_t and_mask, std::uint16_t or_mask) override {
    const std::uint16_t old = values[{Table::holding_registers, address}];
    return write("mask", Table::holding_registers, address,
                 {static_cast<std::uint16_t>((old & and_mask) | (or_mask & ~and_mask))});
  }
  Result<> read_file_record(std::uint16_t number, std::uint16_t record,
                            Span<std::uint16_t> registers) override {
    requests.push_back(fmt::format("read file {} {}+{}", number, record, registers.size()));
    if (const auto error = planned()) return tl::make_unexpected(*error);
    if (file.empty()) return fail(ExceptionReply{modbus::Exception::illegal_function});
    for (std::size_t i = 0; i < registers.size(); ++i) {
      const std::size_t at = 2 * ((number - 1) * std::size_t{modbus::records_per_file} + record + i);
      registers[i] = static_cast<std::uint16_t>(byte(at) << 8 | byte(at + 1));
    }
    return {};
  }

 private:
  std::optional<Error> planned() {
    if (!connected) return Error(NotConnected{"not connected"});
    if (next_errors.empty()) return std::nullopt;
    const Error error = next_errors.front();
    next_errors.pop_front();
    return error;
  }
  template <class Put>
  Result<> read(Table table, modbus::Range range, Put&& put) {
    requests.push_back(fmt::format("read {} {}+{}", to_string(table), range.start(), range.count()));
    if (const auto error = planned()) return tl::make_unexpected(*error);
    for (std::uint32_t i = 0; i < range.count(); ++i)
      if (missing.count({table, range.start() + i}) != 0)
        return fail(ExceptionReply{modbus::Exception::illegal_data_address});
    for (std::uint32_t i = 0; i < range.count(); ++i) {
      const auto found = values.find({table, range.start() + i});
      put(i, found == values.end() ? std::uint16_t{0} : found->second);
    }
    return {};
  }
  Result<> write(std::string_view what, Table table, std::uint16_t address,
                 const std::vector<std::uint16_t>& data) {
    requests.push_back(fmt::format("write {} {}", what, address));
    if (const auto error = planned()) return tl::make_unexpected(*error);
    for (std::uint32_t i = 0; i < data.size(); ++i) values[{table, address + i}] = data[i];
    return {};
  }
  std::uint8_t byte(std::size_t at) const {
    return at < file.size() ? static_cast<std::uint8_t>(file[at]) : 0;
  }
};

}  // namespace coupler::driver::test
