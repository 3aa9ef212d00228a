// SPDX-License-Identifier: Apache-2.0
#include "coupler/map/loader/address.hpp"

#include <gtest/gtest.h>

namespace coupler::loader {
namespace {

int modicon(std::string_view text, Table table) {
  const auto address = parse_address(text, table, Addressing::modicon);
  return address ? *address : -1;
}

TEST(Address, Zero_based_is_the_number_on_the_wire) {
  EXPECT_EQ(parse_address("0", Table::coils, Addressing::zero_based), 0);
  EXPECT_EQ(parse_address("00010", Table::coils, Addressing::zero_based), 10);
  EXPECT_EQ(parse_address("40001", Table::holding_registers, Addressing::zero_based), 40001);
  EXPECT_EQ(parse_address("0xFFFF", Table::coils, Addressing::zero_based), 65535);
  EXPECT_FALSE(parse_address("65536", Table::coils, Addressing::zero_based));
}

TEST(Address, A_modicon_number_alone_counts_from_one) {
  for (const Table table : tables) {
    EXPECT_EQ(modicon("1", table), 0);
    EXPECT_EQ(modicon("0001", table), 0);
    EXPECT_EQ(modicon("9999", table), 9998);
    EXPECT_EQ(modicon("0", table), -1);
    EXPECT_EQ(modicon("-1", table), -1);
    EXPECT_EQ(modicon("", table), -1);
  }
}

TEST(Address, Five_digits_begin_with_the_table) {
  EXPECT_EQ(modicon("00001", Table::coils), 0);
  EXPECT_EQ(modicon("10001", Table::discrete_inputs), 0);
  EXPECT_EQ(modicon("39999", Table::input_registers), 9998);
  EXPECT_EQ(modicon("40108", Table::holding_registers), 107);
  EXPECT_EQ(modicon("40000", Table::holding_registers), -1);
}

TEST(Address, Six_digits_begin_with_the_table) {
  EXPECT_EQ(modicon("000001", Table::coils), 0);
  EXPECT_EQ(modicon("065536", Table::coils), 65535);
  EXPECT_EQ(modicon("110000", Table::discrete_inputs), 9999);
  EXPECT_EQ(modicon("300001", Table::input_registers), 0);
  EXPECT_EQ(modicon("465536", Table::holding_registers), 65535);
  EXPECT_EQ(modicon("465537", Table::holding_registers), -1);
  EXPECT_EQ(modicon("4000001", Table::holding_registers), -1);
}

TEST(Address, The_digit_of_another_table_is_an_error_that_names_it) {
  const auto address = parse_address("30001", Table::holding_registers, Addressing::modicon);
  ASSERT_FALSE(address);
  EXPECT_EQ(address.error().what,
            "30001 is not a Modicon address of holding_registers: '3' stands for input_registers");
  EXPECT_EQ(modicon("10000", Table::coils), -1) << "a number alone never has five digits";
}

TEST(Address, Only_a_number_with_its_own_tables_digit_looks_like_modicons) {
  EXPECT_TRUE(looks_like_modicon(10001, Table::discrete_inputs));
  EXPECT_TRUE(looks_like_modicon(49999, Table::holding_registers));
  EXPECT_FALSE(looks_like_modicon(40000, Table::holding_registers));
  EXPECT_FALSE(looks_like_modicon(40001, Table::input_registers));
  EXPECT_FALSE(looks_like_modicon(1, Table::coils));
}

}  // namespace
}  // namespace coupler::loader
