// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <functional>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "coupler/host/scan/ports.hpp"
#include "test/host/core/fake_clock.hpp"

namespace coupler::scan::test {

using host::test::FakeClock;

/// A device without a network, strict as most are: a read with one address that it has not is refused.
class ForeignDevice : public Client {
 public:
  std::array<std::map<std::uint32_t, std::uint16_t>, 4> values;  ///< by table: what it has
  std::set<std::uint8_t> units{1};                               ///< others are silent
  std::set<Table> without;                                       ///< no function reads these tables
  std::uint32_t most_registers = 125;
  std::uint32_t most_bits = 2000;
  modbus::Exception too_many = modbus::Exception::illegal_data_value;
  std::set<std::uint32_t> seams;  ///< registers that no read may run into from below
  std::function<std::optional<host::Error>(std::size_t request)> fails;    ///< counted from 1
  std::map<std::uint8_t, std::vector<IdentificationPage>> identification;  ///< by access
  std::function<void()> before_request;

  bool closes_in_place_of_refusing = false;
  bool refuses_connections = false;
  std::size_t requests = 0;
  std::size_t connects = 0;
  std::size_t refusals = 0;
  std::uint32_t largest = 0;
  std::vector<modbus::Range> reads;

  void fill(Table table, std::uint32_t from, std::uint32_t to, std::uint16_t first = 0) {
    for (std::uint32_t at = from; at <= to; ++at)
      values[index(table)][at] = static_cast<std::uint16_t>(first + at - from);
  }

  Result<> connect() override {
    ++connects;
    if (refuses_connections) return host::fail(host::NotConnected{"connection refused"});
    connected_ = true;
    return {};
  }
  void close() override { connected_ = false; }
  void select(std::uint8_t unit) override { unit_ = unit; }
  Result<> read(Table table, modbus::Range range, std::uint16_t* got) override {
    if (const auto error = next_failure()) return tl::make_unexpected(*error);
    reads.push_back(range);
    if (without.count(table) != 0) return refuse(modbus::Exception::illegal_function);
    if (range.count() > (holds_bits(table) ? most_bits : most_registers)) return refuse(too_many);
    const auto& has = values[index(table)];
    for (std::uint32_t at = range.start(); at < range.end(); ++at)
      if (has.count(at) == 0 || (at > range.start() && seams.count(at) != 0))
        return refuse(modbus::Exception::illegal_data_address);
    for (std::uint32_t at = range.start(); at < range.end(); ++at) *got++ = has.at(at);
    largest = std::max(largest, range.count());
    return {};
  }
  Result<IdentificationPage> identify(modbus::ReadDeviceIdentification wanted) override {
    if (const auto error = next_failure()) return tl::make_unexpected(*error);
    const auto found = identification.find(static_cast<std::uint8_t>(wanted.access));
    if (found == identification.end())
      return host::fail(host::ExceptionReply{modbus::Exception::illegal_function});
    for (const IdentificationPage& page : found->second)
      if (!page.objects.empty() && page.objects.begin()->first >= wanted.object) return page;
    return found->second.back();
  }

 private:
  Result<> refuse(modbus::Exception code) {
    ++refusals;
    if (closes_in_place_of_refusing)
      return host::fail(host::TransportFailure{"the device closed the connection"});
    return host::fail(host::ExceptionReply{code});
  }
  std::optional<host::Error> next_failure() {
    if (before_request) before_request();
    ++requests;
    if (!connected_) return host::NotConnected{"asked without a connection"};
    if (units.count(unit_) == 0) return host::Timeout{std::chrono::milliseconds(1000)};
    return fails ? fails(requests) : std::nullopt;
  }

  bool connected_ = false;
  std::uint8_t unit_ = 1;
};

class Onlooker : public ScanProgress {
 public:
  bool ends = false;
  std::vector<std::string> steps;
  bool is_in_bounds = true;

  void begins(std::string_view step) override { steps.emplace_back(step); }
  void moved(std::uint32_t done, std::uint32_t total, std::uint64_t) override {
    is_in_bounds &= done <= total;
  }
  bool wants_end() const override { return ends; }
};

}  // namespace coupler::scan::test
