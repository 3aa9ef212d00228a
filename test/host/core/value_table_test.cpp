// SPDX-License-Identifier: Apache-2.0
// These tests check what a table returns for stored values, and which waits end. quality_test.cpp checks
// what a device stores.
#include "coupler/host/core/value_table.hpp"

#include <gtest/gtest.h>

#include <future>

#include "test/fakes/map_builder.hpp"

namespace coupler::host {
namespace {

using codec::Type;
using fakes::MapBuilder;
using Offline = ValueTable::Offline;
using State = PointQuality::State;
using Words = std::vector<std::uint16_t>;
using std::chrono::milliseconds;

Time now() { return std::chrono::steady_clock::now(); }
Time far_away() { return now() + std::chrono::minutes(10); }

struct ValueTableTest : testing::Test {
  void make(const MapBuilder& builder) {
    owned = builder.build();
    table.emplace(owned->map());
  }
  /// Registers from address 0 on, of all points.
  void store(const Words& words, Stamp stamp) {
    ReadSpan span{
        Table::holding_registers, modbus::Range::of(0, static_cast<std::uint32_t>(words.size())), {}};
    for (std::uint32_t i = 0; i < owned->map().points.size(); ++i) span.points.push_back(i);
    table->store(span, words, stamp, stamp.at);
  }
  /// A wait that has not ended.
  std::future<bool> wait_for_a(Time since, Offline offline) {
    auto waits = std::async(std::launch::async, [=] { return table->wait(0, since, far_away(), offline); });
    EXPECT_EQ(waits.wait_for(milliseconds(20)), std::future_status::timeout);
    return waits;
  }

  MapPtr owned;
  std::optional<ValueTable> table;
};

TEST_F(ValueTableTest, A_point_has_the_registers_and_the_bits_that_are_its_own) {
  make(MapBuilder()
           .holding("a", 0)
           .holding("b", 1, Type::DINT)
           .holding("c", 3, fakes::half(Type::BYTE, codec::Half::low)));
  store({1, 2, 3, 0x0405}, {now(), milliseconds(7)});
  EXPECT_EQ(table->get(0, now()).registers, Words({1}));
  EXPECT_EQ(table->get(1, now()).registers, Words({2, 3}));
  EXPECT_EQ(table->get(2, now()).registers, Words({0x0005}));
  EXPECT_EQ(table->get(2, now()).stamp.uncertainty, milliseconds(7));
}

TEST_F(ValueTableTest, The_first_value_differs_and_later_ones_if_their_own_bits_do) {
  make(MapBuilder().holding("low", 0, fakes::half(Type::BYTE, codec::Half::low)));
  store({0}, {now(), {}});
  EXPECT_TRUE(table->differs(0)) << "the first one, even 0";
  store({0x0100}, {now(), {}});
  EXPECT_FALSE(table->differs(0)) << "the other half of the register is not its own";
  store({0x0101}, {now(), {}});
  EXPECT_TRUE(table->differs(0));
}

TEST_F(ValueTableTest, A_value_of_another_connection_is_stale_until_it_is_read) {
  make(MapBuilder().holding("a", 0));
  table->online(true);
  store({5}, {now(), {}});
  EXPECT_EQ(table->quality(0, now()).state, State::good);
  table->begin();
  EXPECT_EQ(table->quality(0, now()).state, State::offline);
  table->online(true);
  EXPECT_EQ(table->quality(0, now()).state, State::stale);
  EXPECT_EQ(table->get(0, now()).registers, Words({5}));
  store({5}, {now(), {}});
  EXPECT_FALSE(table->differs(0));
  EXPECT_EQ(table->quality(0, now()).state, State::good);
}

TEST_F(ValueTableTest, A_value_of_another_connection_stays_stale_while_a_write_hides_what_is_read) {
  make(MapBuilder().holding("a", 0));
  store({5}, {now(), {}});
  table->begin();
  table->online(true);
  const std::uint32_t a = 0;
  table->good({&a, 1}, now());
  EXPECT_EQ(table->quality(0, now()).state, State::stale);
  EXPECT_FALSE(table->wait(0, Time::min(), now(), Offline::waits));
}

TEST_F(ValueTableTest, A_rejected_point_is_good_when_it_is_read_after_all) {
  make(MapBuilder().holding("a", 0));
  table->online(true);
  const std::uint32_t a = 0;
  table->rejected({&a, 1}, modbus::Exception::illegal_function);
  EXPECT_EQ(table->quality(0, now()).state, State::rejected);
  store({5}, {now(), {}});
  EXPECT_EQ(table->quality(0, now()).state, State::good);
}

TEST_F(ValueTableTest, A_value_that_is_replaced_by_a_write_is_good_though_it_is_not_stored) {
  make(MapBuilder().holding("a", 0));
  table->online(true);
  const std::uint32_t a = 0;
  table->good({&a, 1}, now());
  EXPECT_EQ(table->quality(0, now()).state, State::good);
  EXPECT_EQ(table->get(0, now()).registers, Words());
}

TEST_F(ValueTableTest, A_wait_gets_a_value_from_its_time_on) {
  make(MapBuilder().holding("a", 0));
  table->online(true);
  const Time since = now();
  store({7}, {since - milliseconds(1), {}});
  EXPECT_FALSE(table->wait(0, since, since, Offline::gives_up)) << "it was true before";
  store({7}, {since + milliseconds(1), milliseconds(2)});
  EXPECT_FALSE(table->wait(0, since, since, Offline::gives_up)) << "it may have been true before";
  auto waits = wait_for_a(since, Offline::gives_up);
  store({8}, {since + milliseconds(1), {}});
  EXPECT_TRUE(waits.get());
}

TEST_F(ValueTableTest, A_wait_that_gives_up_offline_ends_when_the_device_is_lost) {
  make(MapBuilder().holding("a", 0));
  EXPECT_FALSE(table->wait(0, now(), far_away(), Offline::gives_up)) << "it begins offline";
  table->online(true);
  auto waits = wait_for_a(now(), Offline::gives_up);
  table->online(false);
  EXPECT_FALSE(waits.get());
}

TEST_F(ValueTableTest, Another_wait_is_for_the_first_value_of_a_connection) {
  make(MapBuilder().holding("a", 0));
  store({7}, {now(), {}});
  table->begin();
  EXPECT_FALSE(table->wait(0, Time::min(), now(), Offline::waits)) << "it is from before";
  auto waits = wait_for_a(Time::min(), Offline::waits);
  table->online(true);
  store({7}, {now(), {}});
  EXPECT_TRUE(waits.get());
}

TEST_F(ValueTableTest, The_end_of_waits_ends_those_to_come_too) {
  make(MapBuilder().holding("a", 0));
  table->online(true);
  auto waits = wait_for_a(now(), Offline::waits);
  table->end_waits();
  EXPECT_FALSE(waits.get());
  EXPECT_FALSE(table->wait(0, now(), far_away(), Offline::waits));
}

}  // namespace
}  // namespace coupler::host
