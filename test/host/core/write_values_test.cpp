// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/core/write_values.hpp"

#include <gmock/gmock.h>

#include "test/fakes/map_builder.hpp"
#include "test/host/core/fake_device.hpp"

namespace coupler::host {
namespace {

using codec::Half;
using codec::Type;
using fakes::MapBuilder;
using test::FakeDevice;
using testing::ElementsAre;

struct WriteValuesTest : testing::Test {
  Result<> write(const MapBuilder& builder, std::vector<std::uint16_t> registers) {
    const auto owned = builder.build();
    Write write;
    std::copy(registers.begin(), registers.end(), write.registers.begin());
    device.connected = true;
    WriteBatch batch(owned->map());
    batch.add(write);
    return exchange(batch, owned->map(), device);
  }
  std::uint16_t holding(std::uint32_t address) { return device.values[{Table::holding_registers, address}]; }
  FakeDevice device;
};

TEST_F(WriteValuesTest, A_coil_is_written_by_one_request) {
  ASSERT_TRUE(write(MapBuilder().coil("a", 7), {1}));
  EXPECT_THAT(device.requests, ElementsAre("write coil 7"));
  EXPECT_EQ((device.values[{Table::coils, 7}]), 1);
}

TEST_F(WriteValuesTest, One_register_is_written_as_a_single_one) {
  ASSERT_TRUE(write(MapBuilder().holding("a", 7), {0xABCD}));
  EXPECT_THAT(device.requests, ElementsAre("write register 7"));
  EXPECT_EQ(holding(7), 0xABCD);
}

TEST_F(WriteValuesTest, A_wide_value_is_written_by_one_request) {
  ASSERT_TRUE(write(MapBuilder().holding("a", 7, Type::LREAL), {1, 2, 3, 4}));
  EXPECT_THAT(device.requests, ElementsAre("write registers 7+4"));
  EXPECT_EQ(holding(10), 4);
}

TEST_F(WriteValuesTest, A_byte_keeps_the_other_half_of_its_register) {
  device.values[{Table::holding_registers, 7}] = 0x1234;
  ASSERT_TRUE(write(MapBuilder().holding("a", 7, fakes::half(Type::USINT, Half::high)), {0xAB00}));
  EXPECT_THAT(device.requests, ElementsAre("read holding_registers 7+1", "write register 7"));
  EXPECT_EQ(holding(7), 0xAB34);
}

TEST_F(WriteValuesTest, A_bit_keeps_the_other_bits_of_its_register) {
  device.values[{Table::holding_registers, 7}] = 0x1234;
  codec::Format bit;
  bit.type = Type::BOOL;
  bit.bit = 2;
  ASSERT_TRUE(write(MapBuilder().holding("a", 7, bit), {0}));
  EXPECT_EQ(holding(7), 0x1230);
}

TEST_F(WriteValuesTest, A_device_with_mask_write_needs_no_read_for_a_byte) {
  device.values[{Table::holding_registers, 7}] = 0x1234;
  auto builder = MapBuilder().holding("a", 7, fakes::half(Type::USINT, Half::low));
  builder.head().limits.mask_write = true;
  ASSERT_TRUE(write(builder, {0x00AB}));
  EXPECT_THAT(device.requests, ElementsAre("write mask 7"));
  EXPECT_EQ(holding(7), 0x12AB);
}

TEST_F(WriteValuesTest, Nothing_is_written_when_the_rest_of_the_register_cannot_be_read) {
  device.missing.insert({Table::holding_registers, 7});
  EXPECT_FALSE(write(MapBuilder().holding("a", 7, fakes::half(Type::USINT, Half::low)), {1}));
  EXPECT_THAT(device.requests, ElementsAre("read holding_registers 7+1"));
}

}  // namespace
}  // namespace coupler::host
