// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "test/common/map/loader/loaded.hpp"

namespace coupler {
namespace {

using codec::Encoding;
using codec::Half;
using codec::Order;
using codec::Type;
using test::OnePoint;

std::vector<std::uint16_t> initial(const OnePoint& point) {
  return {point->initial.begin(), point->initial.end()};
}

TEST(Point, A_bit_is_its_address_alone) {
  const OnePoint coil("coils", "7");
  EXPECT_EQ(coil->table, Table::coils);
  EXPECT_EQ(coil->address, 7);
  EXPECT_EQ(coil->format.type, Type::BOOL);
  EXPECT_EQ(coil->access, Access::read_write);
  EXPECT_TRUE(coil->initial.empty());
  EXPECT_FALSE(coil->line.present());
}

TEST(Point, Inputs_are_read_and_outputs_written_too) {
  EXPECT_EQ(OnePoint("discrete_inputs", "0")->access, Access::read);
  EXPECT_EQ(OnePoint("input_registers", "{address: 0, type: INT}")->access, Access::read);
  EXPECT_EQ(OnePoint("holding_registers", "{address: 0, type: INT}")->access, Access::read_write);
}

TEST(Point, Types_are_known_in_any_case) {
  EXPECT_EQ(OnePoint("input_registers", "{address: 0, type: uint}")->format.type, Type::UINT);
  EXPECT_EQ(OnePoint("input_registers", "{address: 0, type: \"LReal\"}")->format.type, Type::LREAL);
}

TEST(Point, A_byte_has_its_half) {
  EXPECT_EQ(OnePoint("input_registers", "{address: 0, type: SINT, offset: LOW}")->format.half, Half::low);
  EXPECT_EQ(OnePoint("input_registers", "{address: 0, type: CHAR, offset: high}")->format.half, Half::high);
}

TEST(Point, A_bit_of_a_register_has_its_place) {
  const OnePoint bit("holding_registers", "{address: 9, type: BOOL, bit: 15, initial: on}");
  EXPECT_EQ(bit->format.bit, 15);
  EXPECT_EQ(initial(bit), std::vector<std::uint16_t>{0x8000});
}

TEST(Point, The_map_orders_the_registers_of_wide_values) {
  const std::string real = "{address: 0, type: REAL}";
  EXPECT_EQ(OnePoint("input_registers", real)->format.order, Order::CDAB);
  EXPECT_EQ(OnePoint("input_registers", real, "wordorder_reverse: true")->format.order, Order::ABCD);
  EXPECT_EQ(OnePoint("input_registers", real, "byteorder_reverse: true")->format.order, Order::DCBA);
  EXPECT_EQ(
      OnePoint("input_registers", real, "byteorder_reverse: true\nwordorder_reverse: true")->format.order,
      Order::BADC);
}

TEST(Point, One_register_keeps_only_the_order_of_its_bytes) {
  EXPECT_EQ(OnePoint("input_registers", "{address: 0, type: INT}")->format.order, Order::ABCD);
  EXPECT_EQ(OnePoint("input_registers", "{address: 0, type: INT}", "byteorder_reverse: yes")->format.order,
            Order::BADC);
  EXPECT_EQ(OnePoint("input_registers", "{address: 0, type: BYTE, offset: low}", "byteorder_reverse: on")
                ->format.order,
            Order::BADC);
}

TEST(Point, Its_own_order_overrides_the_map) {
  EXPECT_EQ(OnePoint("input_registers", "{address: 0, type: DINT, order: BADC}")->format.order, Order::BADC);
  EXPECT_EQ(OnePoint("input_registers", "{address: 0, type: INT, order: AB}", "byteorder_reverse: true")
                ->format.order,
            Order::ABCD);
  EXPECT_EQ(OnePoint("input_registers", "{address: 0, type: BOOL, bit: 0, order: BA}")->format.order,
            Order::BADC);
}

TEST(Point, A_string_has_an_order_of_its_own) {
  const std::string text = "{address: 0, type: STRING, length: 3, encoding: Latin_1";
  const OnePoint swapped("input_registers", text + "}", "wordorder_reverse: true");
  EXPECT_EQ(swapped->format.order, Order::BADC);
  EXPECT_EQ(swapped->format.length, 3);
  EXPECT_EQ(swapped->format.encoding, Encoding::latin1);
  EXPECT_EQ(OnePoint("input_registers", text + ", ignore_byteorder: true}", "byteorder_reverse: true")
                ->format.order,
            Order::ABCD);
}

TEST(Point, An_initial_value_stands_in_the_registers_as_on_the_wire) {
  EXPECT_EQ(initial(OnePoint("coils", "{address: 0, initial: on}")), std::vector<std::uint16_t>{1});
  EXPECT_EQ(initial(OnePoint("discrete_inputs", "{address: 0, initial: \"off\"}")),
            std::vector<std::uint16_t>{0});
  EXPECT_EQ(initial(OnePoint("holding_registers", "{address: 0, type: INT, initial: -2}")),
            std::vector<std::uint16_t>{0xFFFE});
  EXPECT_EQ(initial(OnePoint("input_registers", "{address: 0, type: UDINT, initial: 0x12345678}")),
            (std::vector<std::uint16_t>{0x5678, 0x1234}));
  EXPECT_EQ(initial(OnePoint("input_registers", "{address: 0, type: REAL, order: ABCD, initial: 1.5}")),
            (std::vector<std::uint16_t>{0x3FC0, 0}));
  EXPECT_EQ(initial(OnePoint("input_registers", "{address: 0, type: USINT, offset: high, initial: 255}")),
            std::vector<std::uint16_t>{0xFF00});
  EXPECT_EQ(initial(OnePoint("input_registers",
                             "{address: 0, type: ULINT, order: ABCD, initial: 18446744073709551615}")),
            std::vector<std::uint16_t>(4, 0xFFFF));
  EXPECT_EQ(initial(OnePoint("holding_registers", "{address: 0, type: STRING, length: 4, initial: abc}")),
            (std::vector<std::uint16_t>{0x6261, 0x0063}));
}

TEST(Point, A_bit_string_starts_as_a_number_or_a_list_of_its_bits) {
  EXPECT_EQ(initial(OnePoint("input_registers", "{address: 0, type: WORD, initial: 0xA001}")),
            std::vector<std::uint16_t>{0xA001});
  EXPECT_EQ(initial(OnePoint("input_registers",
                             "{address: 0, type: BYTE, offset: low, "
                             "initial: [true, off, false, false, false, false, false, on]}")),
            std::vector<std::uint16_t>{0x0081});
}

TEST(Point, Words_for_people_are_kept) {
  const OnePoint point("input_registers", "{address: 0, type: INT, description: \"left\\narm\", units: 1}");
  EXPECT_EQ(point->description, "left\narm");
  EXPECT_EQ(point->units, "1");
}

TEST(Point, Units_with_a_number_do_not_scale_and_that_is_said) {
  const auto said = [](const std::string& options) {
    return test::text_of(
        load_map(test::map_of("input_registers", "a: {address: 0, type: UINT, " + options + "}"), "m.yaml")
            .diagnostics);
  };
  EXPECT_THAT(
      said("units: 0.1V"),
      testing::HasSubstr("warning: the units '0.1V' do not scale the value: 'a' is published as it is "
                         "in the register; write 'scale: 0.1' and the units 'V'"));
  EXPECT_THAT(said("units: 0.01 Hz"), testing::HasSubstr("write 'scale: 0.01' and the units 'Hz'"));
  for (const char* good :
       {"units: 0.1V, scale: 0.1", "units: V", "units: 1/min", "units: 1", "units: 100", "units: m3/h",
        "units: '0=off, 1=on'", "units: '0 to 100 %'", "units: 0x01", "units: 16 bit", "units: 24h",
        "units: '10^3 kWh'", "units: 1000 imp/kWh per phase", "units: '10, 20'", "units: '100: full'"})
    EXPECT_EQ(said(good), "") << good;
}

TEST(Point, Bytes_and_bits_share_a_register) {
  const MapPtr owned =
      test::load_clean(test::map_of("holding_registers",
                                    "low: {address: 5, type: BYTE, offset: low}, b8: {address: 5, type: "
                                    "BOOL, bit: 8}, b9: {address: 5, type: BOOL, bit: 9}"));
  EXPECT_EQ(owned->map().points.size(), 3U);
}

TEST(Point, The_last_address_is_taken) {
  EXPECT_EQ(OnePoint("input_registers", "{address: 65532, type: LREAL}")->address, 65532);
  EXPECT_EQ(OnePoint("coils", "0xFFFF")->address, 65535);
}

TEST(Point, Modicons_numbers_are_converted) {
  EXPECT_EQ(OnePoint("holding_registers", "{address: 40108, type: INT}", "addressing: modicon")->address,
            107);
  EXPECT_EQ(OnePoint("coils", "1", "addressing: modicon")->address, 0);
}

TEST(Point, Modicons_numbers_may_be_meant_as_they_are) {
  EXPECT_EQ(OnePoint("holding_registers", "{address: 40108, type: INT}", "addressing: zero_based")->address,
            40108);
}

}  // namespace
}  // namespace coupler
