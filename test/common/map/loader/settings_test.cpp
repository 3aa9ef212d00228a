// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "test/common/map/loader/loaded.hpp"

namespace coupler {
namespace {

using namespace std::chrono_literals;

TEST(Settings, What_the_map_does_not_say_has_the_origins_defaults) {
  const MapPtr owned = test::load_with("");
  const Map& map = owned->map();
  EXPECT_EQ(map.connection.address, "");
  EXPECT_EQ(map.connection.port, 502);
  EXPECT_EQ(map.connection.unit, 1);
  EXPECT_EQ(map.connection.timeout, 3s);
  EXPECT_EQ(map.polling.rate, 10);
  EXPECT_FALSE(map.polling.discrete_continuous);
  EXPECT_EQ(map.polling.discrete_gap, 64);
  EXPECT_FALSE(map.polling.register_continuous);
  EXPECT_EQ(map.polling.register_gap, 12);
  EXPECT_EQ(map.limits.read_registers, 125);
  EXPECT_EQ(map.limits.read_bits, 2000);
  EXPECT_EQ(map.limits.write_registers, 123);
  EXPECT_EQ(map.limits.write_bits, 1968);
  EXPECT_EQ(map.limits.connections, 1);
  EXPECT_FALSE(map.limits.mask_write);
  EXPECT_TRUE(map.limits.transaction_ids);
}

TEST(Settings, A_bare_timeout_means_seconds) {
  EXPECT_EQ(test::load_with("timeout: 2")->map().connection.timeout, 2s);
  EXPECT_EQ(test::load_with("timeout: 0.25")->map().connection.timeout, 250ms);
  EXPECT_EQ(test::load_with("timeout: 40ms")->map().connection.timeout, 40ms);
}

TEST(Settings, An_address_is_text_even_if_it_looks_like_a_number) {
  EXPECT_EQ(test::load_with("address: 1e3")->map().connection.address, "1e3");
}

TEST(Settings, The_rate_may_be_a_fraction) {
  EXPECT_EQ(test::load_with("rate: 0.5")->map().polling.rate, 0.5);
}

TEST(Settings, All_limits_are_read) {
  const MapPtr owned = test::load_with(
      "limits: {read_registers: 64, read_bits: 512, write_registers: 32, write_bits: 256, request_gap: 5ms, "
      "connect_delay: 0.1s, connections: 4, mask_write: true, transaction_ids: false}");
  const Limits& limits = owned->map().limits;
  EXPECT_EQ(limits.read_registers, 64);
  EXPECT_EQ(limits.read_bits, 512);
  EXPECT_EQ(limits.write_registers, 32);
  EXPECT_EQ(limits.write_bits, 256);
  EXPECT_EQ(limits.request_gap, 5ms);
  EXPECT_EQ(limits.connect_delay, 100ms);
  EXPECT_EQ(limits.connections, 4);
  EXPECT_TRUE(limits.mask_write);
  EXPECT_FALSE(limits.transaction_ids);
}

TEST(Settings, Wires_of_the_simulated_chip_lead_to_inputs) {
  const MapPtr owned = test::load_clean(
      "name: press\n"
      "mapping: {coils: {out: 0}, discrete_inputs: {in: 0, not_in: 1, pulse: 2}}\n"
      "sim:\n"
      "  - {from: out, to: in}\n"
      "  - {from: out, to: not_in, invert: true}\n"
      "  - {to: pulse, square: 1s}\n");
  const auto sim = owned->map().sim;
  ASSERT_EQ(sim.size(), 3U);
  EXPECT_EQ(sim[0].from, "out");
  EXPECT_EQ(sim[0].to, "in");
  EXPECT_FALSE(sim[0].invert);
  EXPECT_TRUE(sim[1].invert);
  EXPECT_EQ(sim[2].from, "");
  EXPECT_EQ(sim[2].square, 1s);
}

}  // namespace
}  // namespace coupler
