// SPDX-License-Identifier: Apache-2.0
// Units behind a gateway, for tests.
#pragma once

#include <gtest/gtest.h>

#include <array>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <map>
#include <memory>
#include <thread>
#include <vector>

#include "coupler/host/modbus/make_links.hpp"
#include "test/fakes/map_builder.hpp"
#include "test/host/modbus/modbus_server.hpp"

namespace coupler::host {

/// Takes one connection at a time. Each unit has registers with a hundred times its number; writes of one
/// value are acknowledged.
class Gateway {
 public:
  std::atomic<int> silent{-1};             ///< the unit that never answers
  std::atomic<int> unanswered{0};          ///< so many requests to it have come
  std::atomic<int> away{-1};               ///< the unit that is answered for with exception 0B
  std::atomic<bool> ends{false};           ///< hangs up instead of the next answer
  std::atomic<int> ends_each{0};           ///< hangs up after so many requests, again and again; 0: never
  std::atomic<int> held{-1};               ///< the unit whose reads are not answered for now
  std::atomic<bool> holds{false};          ///< a read of it has come
  std::atomic<int> reads{0};               ///< so many have come
  std::atomic<int> written{-1};            ///< the unit that was written to last
  std::atomic<int> reads_before_write{0};  ///< `reads` when the last write came

  std::uint16_t port() const { return server_.port(); }

 private:
  bool answer(int fd) {
    std::array<std::uint8_t, 12> query{};
    if (::recv(fd, query.data(), query.size(), MSG_WAITALL) != static_cast<ssize_t>(query.size()))
      return false;
    if (ends.exchange(false) || (ends_each > 0 && ++requests_ % ends_each == 0)) return false;
    const std::uint8_t unit = query[6];
    if (query[7] == 3)
      ++reads;
    else
      reads_before_write = reads.load();
    while (query[7] == 3 && unit == held) {
      holds = true;
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    holds = false;
    if (unit == silent) {
      ++unanswered;
      return true;
    }
    const auto refused = static_cast<std::uint8_t>(query[7] | 0x80U);
    if (unit == away) return reply(fd, query, {unit, refused, 0x0B});
    if (query[7] != 3) {
      written = unit;
      return ::send(fd, query.data(), query.size(), MSG_NOSIGNAL) > 0;
    }
    const unsigned value = 100U * unit;
    return reply(fd, query,
                 {unit, 3, 2, static_cast<std::uint8_t>(value >> 8U), static_cast<std::uint8_t>(value)});
  }
  static bool reply(int fd, const std::array<std::uint8_t, 12>& query, std::vector<std::uint8_t> rest) {
    std::vector<std::uint8_t> adu{query[0], query[1], 0, 0, 0, static_cast<std::uint8_t>(rest.size())};
    adu.insert(adu.end(), rest.begin(), rest.end());
    return ::send(fd, adu.data(), adu.size(), MSG_NOSIGNAL) > 0;
  }

  int requests_ = 0;
  test::LoopbackServer server_{[this](int fd) { return answer(fd); }};  // last: its thread uses the others
};

struct SharedChannelTest : testing::Test {
  static constexpr std::uint8_t units = 3;

  MapPtr make_map(std::uint8_t unit, std::uint16_t connections = 1) const {
    fakes::MapBuilder builder;
    const auto safe = builder.keep({7});
    builder.add(Table::holding_registers, "level", 1, codec::Type::UINT, [&](Point& point) {
      point.safe = Safe::on;
      point.safe_value = safe;
    });
    builder.head().on_shutdown = on_shutdown;
    const auto known = patience.find(unit);
    builder.head().connection = {"localhost", port, unit,
                                 known == patience.end() ? std::chrono::milliseconds(20000) : known->second};
    builder.head().limits.connections = connections;
    builder.head().polling.rate = 200;
    return builder.build();
  }
  void make(std::uint16_t connections = 1) {
    std::vector<Map> maps;
    for (std::uint8_t unit = 1; unit <= units; ++unit)
      maps.push_back(owned.emplace_back(make_map(unit, connections))->map());
    links = make_links(maps);
  }
  void connect_all() {
    make();
    for (const auto& link : links) ASSERT_TRUE(link->connect());
  }
  Link& unit(int number) { return *links[static_cast<std::size_t>(number - 1)]; }
  Result<> read(int number) {
    return unit(number).read(Table::holding_registers, modbus::Range::of(1, 1), &word);
  }

  Gateway gateway;
  std::uint16_t port = gateway.port();
  std::map<std::uint8_t, std::chrono::milliseconds> patience;  ///< of a unit's link, where it is to end
  OnShutdown on_shutdown = OnShutdown::hold;
  std::uint16_t word = 0;
  std::vector<MapPtr> owned;
  std::vector<std::unique_ptr<Link>> links;
};

}  // namespace coupler::host
