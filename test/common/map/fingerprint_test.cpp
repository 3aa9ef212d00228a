// SPDX-License-Identifier: Apache-2.0
#include "coupler/map/fingerprint.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "test/common/map/sample_points.hpp"

namespace coupler {
namespace {

// python3 -c 'import hashlib, sys; print(hashlib.sha256(sys.stdin.buffer.read()).hexdigest()[:16])'
// gives b3aaa998215aab0f for this text and e3b0c44298fc1c14 for none.
constexpr const char* sample_text =
    "coils 3 - valve BOOL - 1 - - - 0x1p+0:0x0p+0 read_write\n"
    "input_registers 9 low state USINT AB 1 - - - 0x1p+0:0x0p+0 read\n"
    "input_registers 9 bit15 ready BOOL AB 1 - - - 0x1p+0:0x0p+0 read\n"
    "holding_registers 7 - speed REAL CDAB 1 - - - 0x1p+0:0x0p+0 read_write\n"
    "holding_registers 40012 - name STRING BA 1 12 utf-8 false 0x1p+0:0x0p+0 read_write\n";
constexpr std::uint64_t sample_fingerprint = 0xb3aaa998215aab0f;

TEST(Fingerprint, The_canonical_text_has_one_line_a_point_in_canonical_order) {
  const MapPtr owned = test::map_of(test::sample_points());
  EXPECT_EQ(canonical_text(owned->map().points), sample_text);
}

TEST(Fingerprint, It_is_what_python_computes) {
  EXPECT_EQ(test::map_of(test::sample_points())->map().fingerprint, sample_fingerprint);
  EXPECT_EQ(test::map_of({})->map().fingerprint, 0xe3b0c44298fc1c14U);
}

TEST(Fingerprint, The_order_of_the_file_is_not_in_it) {
  auto points = test::sample_points();
  std::reverse(points.begin(), points.end());
  EXPECT_EQ(test::map_of(points)->map().fingerprint, sample_fingerprint);
}

TEST(Fingerprint, Arrays_have_their_count_and_scales_are_hexadecimal_as_in_c) {
  Point point;
  point.name = "heat";
  point.table = Table::input_registers;
  point.address = 4;
  point.format.type = codec::Type::INT;
  point.count = 3;
  point.scale = {0.1, -273.15};
  EXPECT_EQ(canonical_line(point),
            "input_registers 4 - heat INT AB 3 - - - 0x1.999999999999ap-4:-0x1.1126666666666p+8 read");
}

TEST(Fingerprint, Deployment_is_not_in_it) {
  auto points = test::sample_points();
  for (Point& point : points) {
    point.description = "moved to another board";
    point.units = "mm";
    point.line.name = "GPIO17";
    point.safe = Safe::hold;
    point.host.rate = 3;
    point.read_address = 512;
    point.pwm.chip = "pwmchip0";
  }
  EXPECT_EQ(test::map_of(points)->map().fingerprint, sample_fingerprint);
}

TEST(Fingerprint, Whatever_both_sides_must_agree_on_changes_it) {
  const std::vector<void (*)(Point&)> changes{
      [](Point& p) { p.name = "other"; },
      [](Point& p) { p.table = Table::input_registers; },
      [](Point& p) { p.address = 40013; },
      [](Point& p) { p.format.length = 11; },
      [](Point& p) { p.format.order = codec::Order::ABCD; },
      [](Point& p) { p.format.encoding = codec::Encoding::latin1; },
      [](Point& p) { p.format.type = codec::Type::INT; },
      [](Point& p) { p.access = Access::read; },
  };
  for (std::size_t i = 0; i < changes.size(); ++i) {
    auto points = test::sample_points();
    changes[i](points[0]);
    EXPECT_NE(test::map_of(points)->map().fingerprint, sample_fingerprint) << "change " << i;
  }
}

TEST(Fingerprint, It_is_written_with_sixteen_digits) {
  EXPECT_EQ(fingerprint_text(sample_fingerprint), "b3aaa998215aab0f");
  EXPECT_EQ(fingerprint_text(0xAB), "00000000000000ab");
}

}  // namespace
}  // namespace coupler
