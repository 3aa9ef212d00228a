// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/core/write_batch.hpp"

#include <gmock/gmock.h>

#include "coupler/modbus/server.hpp"
#include "test/fakes/map_builder.hpp"
#include "test/host/core/fake_device.hpp"

namespace coupler::host {
namespace {

using codec::Half;
using codec::Type;
using fakes::MapBuilder;
using test::FakeDevice;
using testing::ElementsAre;

/// A batch of the points of these names; stops at the first that does not go into it.
struct WriteBatchTest : testing::Test {
  int take(MapBuilder& builder, std::initializer_list<const char*> names) {
    owned = builder.build();
    batch.emplace(owned->map());
    int taken = 0;
    for (const char* name : names) {
      const std::uint16_t one = 1;
      const auto point = static_cast<std::uint32_t>(find(owned->map(), name) - owned->map().points.begin());
      if (!batch->add(make_write(owned->map(), point, {&one, 1}))) break;
      ++taken;
    }
    return taken;
  }
  static MapBuilder registers(void (*adjust)(Point&)) {
    MapBuilder builder;
    for (std::uint16_t i = 0; i < 4; ++i)
      builder.add(Table::holding_registers, std::string(1, static_cast<char>('a' + i)), i, Type::UINT,
                  adjust);
    return builder;
  }
  static void plain(Point&) {}
  MapPtr owned;
  std::optional<WriteBatch> batch;
};

TEST_F(WriteBatchTest, Neighbouring_registers_become_one_request_whatever_their_order) {
  auto builder = registers(plain);
  EXPECT_EQ(take(builder, {"b", "a", "c"}), 3);
  const auto request = batch->request();
  const auto parsed = modbus::parse_request(request.pdu());
  EXPECT_EQ(std::get<modbus::WriteRegisters>(*parsed).range, modbus::Range::of(0, 3));
}

TEST_F(WriteBatchTest, Points_with_something_between_them_do_not_merge) {
  auto builder = registers(plain);
  EXPECT_EQ(take(builder, {"a", "c"}), 1);
}

TEST_F(WriteBatchTest, A_request_has_no_more_registers_than_the_device_takes) {
  auto builder = registers(plain);
  builder.head().limits.write_registers = 2;
  EXPECT_EQ(take(builder, {"a", "b", "c"}), 2);
}

TEST_F(WriteBatchTest, A_request_has_no_more_coils_than_the_device_takes) {
  MapBuilder builder;
  builder.many(Table::coils, 0, 9);
  builder.head().limits.write_bits = 8;
  EXPECT_EQ(take(builder, {"coils_0", "coils_1", "coils_2", "coils_3", "coils_4", "coils_5", "coils_6",
                           "coils_7", "coils_8"}),
            8);
}

TEST_F(WriteBatchTest, Points_with_write_function_single_never_merge) {
  auto builder =
      registers([](Point& point) { point.host.write_function = HostOptions::WriteFunction::single; });
  EXPECT_EQ(take(builder, {"a", "b"}), 1);
}

TEST_F(WriteBatchTest, Points_whose_every_value_counts_never_merge) {
  auto builder = registers([](Point& point) { point.host.write_queue = HostOptions::WriteQueue::every; });
  EXPECT_EQ(take(builder, {"a", "b"}), 1);
}

TEST_F(WriteBatchTest, With_write_function_multiple_one_value_goes_by_the_function_for_several) {
  auto builder =
      registers([](Point& point) { point.host.write_function = HostOptions::WriteFunction::multiple; });
  take(builder, {"a"});
  EXPECT_EQ(batch->request().function(), modbus::Function::write_multiple_registers);
  MapBuilder coils;
  coils.add(Table::coils, "k", 0, Type::BOOL,
            [](Point& point) { point.host.write_function = HostOptions::WriteFunction::multiple; });
  take(coils, {"k"});
  EXPECT_EQ(batch->request().function(), modbus::Function::write_multiple_coils);
}

TEST_F(WriteBatchTest, An_array_of_coils_is_one_request) {
  MapBuilder builder;
  builder.add(Table::coils, "k", 3, Type::BOOL, [](Point& point) { point.count = 20; });
  owned = builder.build();
  std::vector<std::uint16_t> bits(20);
  bits[0] = bits[18] = 1;
  batch.emplace(owned->map());
  batch->add(make_write(owned->map(), 0, bits));
  const auto request = batch->request();
  const auto parsed = modbus::parse_request(request.pdu());
  const auto& written = std::get<modbus::WriteBits>(*parsed);
  EXPECT_EQ(written.range, modbus::Range::of(3, 20));
  EXPECT_THAT(std::vector<int>(written.packed.begin(), written.packed.end()), testing::ElementsAre(1, 0, 4));
}

struct WriteExchangeTest : testing::Test {
  Result<> write(const MapBuilder& builder, std::vector<std::uint16_t> registers) {
    const auto owned = builder.build();
    Write write;
    std::copy(registers.begin(), registers.end(), write.registers.begin());
    EXPECT_TRUE(link.connect());
    device.requests.clear();
    WriteBatch batch(owned->map());
    batch.add(write);
    const auto sent = send(batch, owned->map(), link);
    return sent ? link.receive() : sent;
  }
  std::uint16_t holding(std::uint32_t address) { return device.values[{Table::holding_registers, address}]; }
  FakeDevice device;
  Link link{test::share(device), {}, {}};
};

TEST_F(WriteExchangeTest, A_coil_is_written_by_one_request) {
  ASSERT_TRUE(write(MapBuilder().coil("a", 7), {1}));
  EXPECT_THAT(device.requests, ElementsAre("write coil 7"));
  EXPECT_EQ((device.values[{Table::coils, 7}]), 1);
}

TEST_F(WriteExchangeTest, One_register_is_written_as_a_single_one) {
  ASSERT_TRUE(write(MapBuilder().holding("a", 7), {0xABCD}));
  EXPECT_THAT(device.requests, ElementsAre("write register 7"));
  EXPECT_EQ(holding(7), 0xABCD);
}

TEST_F(WriteExchangeTest, A_wide_value_is_written_by_one_request) {
  ASSERT_TRUE(write(MapBuilder().holding("a", 7, Type::LREAL), {1, 2, 3, 4}));
  EXPECT_THAT(device.requests, ElementsAre("write registers 7+4"));
  EXPECT_EQ(holding(10), 4);
}

TEST_F(WriteExchangeTest, A_byte_keeps_the_other_half_of_its_register) {
  device.values[{Table::holding_registers, 7}] = 0x1234;
  ASSERT_TRUE(write(MapBuilder().holding("a", 7, fakes::half(Type::USINT, Half::high)), {0xAB00}));
  EXPECT_THAT(device.requests, ElementsAre("read holding_registers 7+1", "write register 7"));
  EXPECT_EQ(holding(7), 0xAB34);
}

TEST_F(WriteExchangeTest, A_bit_keeps_the_other_bits_of_its_register) {
  device.values[{Table::holding_registers, 7}] = 0x1234;
  codec::Format bit;
  bit.type = Type::BOOL;
  bit.bit = 2;
  ASSERT_TRUE(write(MapBuilder().holding("a", 7, bit), {0}));
  EXPECT_EQ(holding(7), 0x1230);
}

TEST_F(WriteExchangeTest, An_area_that_the_device_gives_whole_is_read_whole_before_a_byte_is_written) {
  static const TableRange area[] = {{Table::holding_registers, modbus::Range::of(5, 4)}};
  device.values[{Table::holding_registers, 7}] = 0x1234;
  auto builder = MapBuilder().holding("a", 7, fakes::half(Type::USINT, Half::high));
  builder.head().read_whole = area;
  ASSERT_TRUE(write(builder, {0xAB00}));
  EXPECT_THAT(device.requests, ElementsAre("read holding_registers 5+4", "write register 7"));
  EXPECT_EQ(holding(7), 0xAB34);
}

TEST_F(WriteExchangeTest, A_device_with_mask_write_needs_no_read_for_a_byte) {
  device.values[{Table::holding_registers, 7}] = 0x1234;
  auto builder = MapBuilder().holding("a", 7, fakes::half(Type::USINT, Half::low));
  builder.head().limits.mask_write = true;
  ASSERT_TRUE(write(builder, {0x00AB}));
  EXPECT_THAT(device.requests, ElementsAre("write mask 7"));
  EXPECT_EQ(holding(7), 0x12AB);
}

TEST_F(WriteExchangeTest, Nothing_is_written_when_the_rest_of_the_register_cannot_be_read) {
  device.missing.insert({Table::holding_registers, 7});
  EXPECT_FALSE(write(MapBuilder().holding("a", 7, fakes::half(Type::USINT, Half::low)), {1}));
  EXPECT_THAT(device.requests, ElementsAre("read holding_registers 7+1"));
}

TEST_F(WriteExchangeTest, A_unit_that_is_away_is_not_asked_for_the_other_values) {
  const auto owned = MapBuilder().coil("a", 0).coil("b", 1).coil("c", 7).build();
  const std::uint16_t on = 1;
  std::vector<Write> writes;
  for (std::uint32_t i = 0; i < 3; ++i) writes.push_back(make_write(owned->map(), i, {&on, 1}));
  ASSERT_TRUE(link.connect());
  device.requests.clear();
  device.next_errors = {ExceptionReply{modbus::Exception::gateway_target_failed_to_respond}};
  const auto rejected = write_values(writes, owned->map(), link);
  ASSERT_FALSE(rejected);
  EXPECT_TRUE(is_unit_away(rejected.error()));
  EXPECT_THAT(device.requests, ElementsAre("write coils 0+2"));
}

}  // namespace
}  // namespace coupler::host
