// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <string>
#include <vector>

#include "coupler/modbus/device_identification.hpp"
#include "coupler/modbus/limits.hpp"

namespace coupler::modbus {
namespace {

using testing::ElementsAre;
using Access = ReadDeviceIdentification::Access;
using Pdu = std::vector<std::uint8_t>;

constexpr std::array<IdentificationObject, 4> objects{{{0, "AB"}, {1, "C"}, {2, "1.0"}, {4, "name"}}};

Pdu reply_to(Access access, int object, Span<const IdentificationObject> of = objects) {
  std::array<std::uint8_t, max_pdu_size> pdu{};
  const auto size = reply_device_identification({access, static_cast<std::uint8_t>(object)}, of, pdu);
  return size ? Pdu(pdu.data(), pdu.data() + *size) : Pdu{0xFF, static_cast<std::uint8_t>(size.error())};
}

TEST(DeviceIdentification, A_request_has_an_access_and_an_object) {
  const auto wanted = parse_device_identification(Pdu{43, 14, 4, 2});
  ASSERT_TRUE(wanted.has_value());
  EXPECT_EQ(wanted->access, Access::individual);
  EXPECT_EQ(wanted->object, 2);
}

TEST(DeviceIdentification, Other_interfaces_are_no_function_and_other_accesses_no_value) {
  const auto refusal = [](const Pdu& pdu) { return parse_device_identification(pdu).error(); };
  EXPECT_EQ(refusal({43, 13, 1, 0}), Exception::illegal_function);
  EXPECT_EQ(refusal({43, 15}), Exception::illegal_function);
  for (const Pdu& pdu : {Pdu{43}, Pdu{43, 14}, Pdu{43, 14, 1}, Pdu{43, 14, 1, 0, 0}, Pdu{43, 14, 0, 0},
                         Pdu{43, 14, 5, 0}, Pdu{43, 14, 255, 0}})
    EXPECT_EQ(refusal(pdu), Exception::illegal_data_value);
}

TEST(DeviceIdentification, The_basic_stream_is_the_first_three_objects) {
  EXPECT_THAT(reply_to(Access::basic, 0),
              ElementsAre(43, 14, 1, 0x82, 0, 0, 3, 0, 2, 'A', 'B', 1, 1, 'C', 2, 3, '1', '.', '0'));
  EXPECT_THAT(reply_to(Access::basic, 2), ElementsAre(43, 14, 1, 0x82, 0, 0, 1, 2, 3, '1', '.', '0'));
}

TEST(DeviceIdentification, The_regular_stream_goes_on_and_the_extended_has_no_more) {
  const Pdu regular = reply_to(Access::regular, 2);
  EXPECT_THAT(regular, ElementsAre(43, 14, 2, 0x82, 0, 0, 2, 2, 3, '1', '.', '0', 4, 4, 'n', 'a', 'm', 'e'));
  Pdu extended = reply_to(Access::extended, 2);
  EXPECT_EQ(extended[2], 3);
  extended[2] = 2;
  EXPECT_EQ(extended, regular);
}

TEST(DeviceIdentification, A_device_with_an_extended_object_says_so_and_gives_it_where_it_is_asked_for) {
  const std::array<IdentificationObject, 5> more{{{0, "AB"}, {1, "C"}, {2, "1.0"}, {6, "x"}, {0x80, "yz"}}};
  EXPECT_THAT(reply_to(Access::basic, 2, more), ElementsAre(43, 14, 1, 0x83, 0, 0, 1, 2, 3, '1', '.', '0'));
  EXPECT_THAT(reply_to(Access::regular, 6, more), ElementsAre(43, 14, 2, 0x83, 0, 0, 1, 6, 1, 'x'));
  EXPECT_THAT(reply_to(Access::extended, 6, more),
              ElementsAre(43, 14, 3, 0x83, 0, 0, 2, 6, 1, 'x', 0x80, 2, 'y', 'z'));
  EXPECT_THAT(reply_to(Access::individual, 0x80, more),
              ElementsAre(43, 14, 4, 0x83, 0, 0, 1, 0x80, 2, 'y', 'z'));
  EXPECT_EQ(reply_to(Access::regular, 0x80, more), reply_to(Access::regular, 0, more));
}

TEST(DeviceIdentification, A_stream_from_an_object_that_is_not_there_begins_at_the_first) {
  EXPECT_EQ(reply_to(Access::regular, 3), reply_to(Access::regular, 0));
  EXPECT_EQ(reply_to(Access::basic, 4), reply_to(Access::basic, 0));
  EXPECT_EQ(reply_to(Access::regular, 0x80), reply_to(Access::regular, 0));
}

TEST(DeviceIdentification, One_object_can_be_read_alone) {
  EXPECT_THAT(reply_to(Access::individual, 4),
              ElementsAre(43, 14, 4, 0x82, 0, 0, 1, 4, 4, 'n', 'a', 'm', 'e'));
  EXPECT_THAT(reply_to(Access::individual, 3), ElementsAre(0xFF, 2));
}

TEST(DeviceIdentification, A_stream_that_does_not_fit_says_where_it_goes_on) {
  const std::string longest(300, 'x');
  const std::array<IdentificationObject, 3> large{{{0, "AB"}, {1, longest}, {2, "1.0"}}};
  EXPECT_THAT(reply_to(Access::basic, 0, large), ElementsAre(43, 14, 1, 0x82, 0xFF, 1, 1, 0, 2, 'A', 'B'));
  const Pdu second = reply_to(Access::basic, 1, large);
  EXPECT_EQ(second.size(), max_pdu_size);
  EXPECT_THAT(Pdu(second.begin() + 4, second.begin() + 9), ElementsAre(0xFF, 2, 1, 1, 244));
  EXPECT_THAT(reply_to(Access::basic, 2, large), ElementsAre(43, 14, 1, 0x82, 0, 0, 1, 2, 3, '1', '.', '0'));
}

}  // namespace

namespace {

class IdentificationReplyTest : public testing::Test {
 protected:
  tl::expected<IdentificationReply, ReplyError> take(const Pdu& pdu) {
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
