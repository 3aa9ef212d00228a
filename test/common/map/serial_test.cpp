// SPDX-License-Identifier: Apache-2.0
#include "coupler/map/serial.hpp"

#include <gtest/gtest.h>

namespace coupler {
namespace {

using std::chrono::microseconds;
using std::chrono::nanoseconds;

Serial line(std::uint32_t baud, Serial::Parity parity = Serial::Parity::even, std::uint16_t stop_bits = 1) {
  return {"/dev/ttyUSB0", baud, parity, stop_bits, false};
}

TEST(Serial, A_character_has_11_bits_by_the_specification) {
  EXPECT_EQ(bits_per_character(line(19200)), 11U);
  EXPECT_EQ(bits_per_character(line(19200, Serial::Parity::none, 2)), 11U);
  EXPECT_EQ(bits_per_character(line(19200, Serial::Parity::none)), 10U);
  EXPECT_EQ(bits_per_character(line(19200, Serial::Parity::odd, 2)), 12U);
}

TEST(Serial, Characters_take_their_bits_at_the_rate) {
  EXPECT_EQ(time_of_characters(line(110), 10), std::chrono::seconds(1));
  EXPECT_EQ(time_of_characters(line(9600), 256), nanoseconds(293'333'333));
}

TEST(Serial, Frames_are_3_and_a_half_characters_apart_and_less_than_2_ms_when_fast) {
  EXPECT_EQ(silence_between_frames(line(9600)), nanoseconds(4'010'416));
  EXPECT_EQ(silence_between_frames(line(19200)), nanoseconds(2'005'208));
  EXPECT_EQ(silence_between_frames(line(38400)), microseconds(1750));
  EXPECT_EQ(silence_between_frames(line(4000000)), microseconds(1750));
}

}  // namespace
}  // namespace coupler
