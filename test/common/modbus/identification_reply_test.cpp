// SPDX-License-Identifier: Apache-2.0
#include "coupler/modbus/identification_reply.hpp"

#include <gmock/gmock.h>

#include <array>
#include <string>
#include <vector>

#include "coupler/modbus/limits.hpp"

namespace coupler::modbus {
namespace {

using Access = ReadDeviceIdentification::Access;
using Pdu = std::vector<std::uint8_t>;

class IdentificationReplyTest : public testing::Test {
 protected:
  tl::expected<IdentificationReply, Refused> take(const Pdu& pdu) {
    return take_device_identification(pdu, objects_);
  }
  std::array<IdentificationObject, max_identification_objects> objects_{};
};

TEST_F(IdentificationReplyTest, What_is_asked_is_what_the_server_reads) {
  const auto pdu = build_device_identification({Access::extended, 0x80});
  const auto parsed = parse_device_identification(pdu);
  ASSERT_TRUE(parsed.has_value());
  EXPECT_EQ(parsed->access, Access::extended);
  EXPECT_EQ(parsed->object, 0x80);
}

/// MAP 6.21, the example of its basic stream.
TEST_F(IdentificationReplyTest, The_example_of_the_specification_is_understood) {
  Pdu pdu{0x2B, 0x0E, 0x01, 0x01, 0x00, 0x00, 0x03};
  for (const std::string text : {"Company identification", "Product code XX", "V2.11"}) {
    pdu.push_back(static_cast<std::uint8_t>(text == "V2.11" ? 2 : text[0] == 'C' ? 0 : 1));
    pdu.push_back(static_cast<std::uint8_t>(text.size()));
    pdu.insert(pdu.end(), text.begin(), text.end());
  }
  const auto taken = take(pdu);
  ASSERT_TRUE(taken.has_value());
  EXPECT_EQ(taken->count, 3U);
  EXPECT_FALSE(taken->more);
  EXPECT_EQ(objects_[0].value, "Company identification");
  EXPECT_EQ(objects_[1].value, "Product code XX");
  EXPECT_EQ(objects_[2].id, 2);
}

TEST_F(IdentificationReplyTest, A_stream_tells_where_it_goes_on) {
  const std::string text(200, 'x');
  const std::array<IdentificationObject, 3> all{{{0, text}, {1, text}, {2, text}}};
  std::array<std::uint8_t, max_pdu_size> pdu{};
  const auto size = reply_device_identification({Access::basic, 0}, all, pdu);
  ASSERT_TRUE(size.has_value());
  const auto taken = take({pdu.begin(), pdu.begin() + static_cast<std::ptrdiff_t>(*size)});
  ASSERT_TRUE(taken.has_value());
  EXPECT_EQ(taken->count, 1U);
  EXPECT_TRUE(taken->more);
  EXPECT_EQ(taken->next, 1);
}

TEST_F(IdentificationReplyTest, An_exception_is_told) {
  const auto taken = take({0xAB, 0x01});
  ASSERT_FALSE(taken.has_value());
  EXPECT_EQ(taken.error().exception, Exception::illegal_function);
}

TEST_F(IdentificationReplyTest, What_is_cut_off_or_something_else_is_no_answer) {
  const Pdu whole{0x2B, 0x0E, 0x01, 0x01, 0x00, 0x00, 0x01, 0x00, 0x02, 'o', 'k'};
  ASSERT_TRUE(take(whole).has_value());
  for (std::size_t size = 0; size < whole.size(); ++size) {
    const auto taken = take({whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(size)});
    ASSERT_FALSE(taken.has_value()) << size;
    EXPECT_FALSE(taken.error().exception.has_value());
  }
  Pdu other = whole;
  other[1] = 0x0D;
  EXPECT_FALSE(take(other).has_value());
}

}  // namespace
}  // namespace coupler::modbus
