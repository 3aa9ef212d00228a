// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "coupler/device/core/server.hpp"
#include "test/device/core/node_under_test.hpp"

namespace coupler::device {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

class Serving : public testing::Test {
 protected:
  Pdu ask(std::uint8_t unit) {
    const Pdu request = pdu(1, {0, 3});
    std::array<std::uint8_t, modbus::max_adu_size> adu{};
    return Pdu(adu.data(),
               adu.data() + server_.answer({0xBEEF, unit, request}, node_.session, node_.now, adu));
  }
  NodeUnderTest node_{fakes::MapBuilder().many(Table::coils, 0, 3).build()};
  Server server_{7, node_.handler, node_.statistics};
};

TEST_F(Serving, Its_own_unit_id_0_and_255_are_answered_and_echoed) {
  for (const auto unit : Pdu{7, 0, 255})
    EXPECT_THAT(ask(unit), ElementsAre(0xBE, 0xEF, 0, 0, 0, 4, unit, 1, 1, 0));
}

TEST_F(Serving, Other_units_get_silence_and_are_counted) {
  for (const auto unit : Pdu{1, 6, 8, 254}) EXPECT_THAT(ask(unit), IsEmpty());
  EXPECT_EQ(node_.statistics.foreign_units, 4U);
  EXPECT_EQ(node_.statistics.requests, 0U);
}

}  // namespace
}  // namespace coupler::device
