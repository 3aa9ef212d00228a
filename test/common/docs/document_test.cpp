// SPDX-License-Identifier: Apache-2.0
#include "coupler/docs/document.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "test/fakes/map_builder.hpp"

namespace coupler::docs {
namespace {

using namespace std::chrono_literals;

/// The value of a fact, or "-" if nobody tells it.
std::string told(const MapPtr& map, const std::string& label) {
  for (const FactGroup& group : facts_of(map->map()))
    for (const Fact& fact : group.facts)
      if (fact.label == label) return fact.value;
  return "-";
}

TEST(Facts, A_foreign_coupler_has_no_identity_area) {
  const auto map = fakes::MapBuilder().many(Table::coils, 0, 2).build();
  EXPECT_EQ(told(map, "Identity area"), "-");
  EXPECT_EQ(told(map, "Watchdog"), "-");
  EXPECT_EQ(told(map, "Fingerprint").size(), 16U);
  EXPECT_EQ(told(map, "Address"), "not in the map");
}

TEST(Facts, Which_points_are_read_is_told) {
  auto builder = fakes::MapBuilder();
  EXPECT_EQ(told(builder.build(), "Points that are read"), "all");
  auto wanted = fakes::MapBuilder();
  wanted.head().poll = Poll::subscribed;
  EXPECT_EQ(told(wanted.build(), "Points that are read"), "those that somebody listens to");
}

TEST(Facts, A_map_with_wiring_is_served_by_a_node_with_an_identity_area) {
  auto builder = fakes::MapBuilder();
  builder.add(Table::coils, "lamp", 0, codec::Type::BOOL, [](Point& point) { point.line.name = "GPIO17"; });
  const auto map = builder.build();
  EXPECT_EQ(told(map, "Identity area"), "85 input registers from 65280 (365281)");
  EXPECT_EQ(told(map, "Fingerprint in it"), "4 from 65283 (365284)");
  EXPECT_EQ(told(map, "Watchdog"), "none");
  EXPECT_EQ(told(map, "Watchdog reset"), "-");
}

TEST(Facts, A_port_without_TLS_is_told_where_the_host_uses_TLS) {
  auto builder = fakes::MapBuilder();
  builder.add(Table::coils, "lamp", 0, codec::Type::BOOL, [](Point& point) { point.line.name = "GPIO17"; });
  builder.head().connection.port = 1802;  // as it is also where a node was reached
  builder.head().service.port = 1502;
  EXPECT_EQ(told(builder.build(), "Port without TLS"), "-");
  auto secured = fakes::MapBuilder();
  secured.add(Table::coils, "lamp", 0, codec::Type::BOOL, [](Point& point) { point.line.name = "GPIO17"; });
  secured.head().connection.port = 1802;
  secured.head().service.port = 1502;
  secured.head().connection.tls.certificate = "cell1.pem";
  EXPECT_EQ(told(secured.build(), "Port without TLS"), "1502");
}

TEST(Facts, A_watchdog_with_manual_recovery_says_how_it_is_reset) {
  const auto map = fakes::MapBuilder()
                       .many(Table::coils, 0, 1)
                       .watchdog({500ms, Watchdog::FedBy::write, Watchdog::Recovery::manual})
                       .build();
  EXPECT_EQ(told(map, "Watchdog"), "500 ms, fed by writes, recovery manual");
  EXPECT_EQ(told(map, "Watchdog reset"), "write 0xAA55 to holding register 65280 (465281)");
}

TEST(Facts, A_watchdog_is_fed_only_by_who_has_written_an_output) {
  const auto map = fakes::MapBuilder()
                       .many(Table::coils, 0, 1)
                       .watchdog({500ms, Watchdog::FedBy::any, Watchdog::Recovery::automatic})
                       .build();
  EXPECT_EQ(told(map, "Watchdog"),
            "500 ms, fed by any request of a client that has written an output, recovery automatic");
}

TEST(Facts, Only_what_is_unusual_of_the_limits_is_told) {
  auto builder = fakes::MapBuilder();
  EXPECT_EQ(told(builder.build(), "Pause before a request"), "-");
  static const TableRange area[] = {{Table::input_registers, modbus::Range::of(100, 10)}};
  auto gentle = fakes::MapBuilder();
  gentle.head().limits.request_gap = 2ms;
  gentle.head().unreadable = area;
  const auto map = gentle.build();
  EXPECT_EQ(told(map, "Pause before a request"), "2 ms");
  EXPECT_EQ(told(map, "Unreadable"), "input registers 100 – 109");
}

}  // namespace
}  // namespace coupler::docs
