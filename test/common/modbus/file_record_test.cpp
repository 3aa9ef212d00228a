// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <vector>

#include "coupler/modbus/file_record.hpp"
#include "coupler/modbus/limits.hpp"

namespace coupler::modbus {
namespace {

using testing::ElementsAre;
using testing::ElementsAreArray;
using Pdu = std::vector<std::uint8_t>;

Pdu request(std::vector<FileRecord> groups) {
  Pdu pdu{0x14, static_cast<std::uint8_t>(groups.size() * 7)};
  for (const FileRecord& g : groups)
    for (const int byte :
         {6, g.file >> 8, g.file & 255, g.record >> 8, g.record & 255, g.registers >> 8, g.registers & 255})
      pdu.push_back(static_cast<std::uint8_t>(byte));
  return pdu;
}

Exception file_refusal(const Pdu& pdu) {
  const auto parsed = parse_file_request(pdu);
  return parsed ? Exception{} : parsed.error();
}

// The example of MAP 6.14: two registers of file 4 from record 1, two of file 3 from record 9.
TEST(FileRecord, The_specifications_example_is_parsed_and_answered) {
  const Pdu pdu{0x14, 0x0E, 0x06, 0, 4, 0, 1, 0, 2, 0x06, 0, 3, 0, 9, 0, 2};
  const auto groups = parse_file_request(pdu);
  ASSERT_TRUE(groups.has_value());
  ASSERT_EQ(groups->size(), 2U);
  EXPECT_EQ((*groups)[0].file, 4);
  EXPECT_EQ((*groups)[0].record, 1);
  EXPECT_EQ((*groups)[1].file, 3);
  EXPECT_EQ((*groups)[1].record, 9);
  EXPECT_EQ((*groups)[1].registers, 2);

  std::array<std::uint8_t, max_pdu_size> out{};
  FileReply reply(out);
  const auto first = reply.add(2);
  first[0] = 0x0D, first[1] = 0xFE, first[2] = 0x00, first[3] = 0x20;
  const auto second = reply.add(2);
  second[0] = 0x33, second[1] = 0xCD, second[2] = 0x00, second[3] = 0x40;
  EXPECT_THAT(
      Pdu(out.data(), out.data() + reply.size()),
      ElementsAre(0x14, 0x0C, 0x05, 0x06, 0x0D, 0xFE, 0x00, 0x20, 0x05, 0x06, 0x33, 0xCD, 0x00, 0x40));
}

TEST(FileRecord, A_client_asks_for_one_group) {
  std::array<std::uint8_t, file_request_size> out{};
  EXPECT_EQ(build_file_request({1, 0x1234, 121}, out), 9U);
  EXPECT_THAT(out, ElementsAreArray(request({{1, 0x1234, 121}})));
}

TEST(FileRecord, A_client_takes_the_registers_out_of_the_reply) {
  std::array<std::uint16_t, 2> registers{};
  EXPECT_TRUE(parse_file_reply(Pdu{0x14, 6, 5, 6, 0x0D, 0xFE, 0x00, 0x20}, registers).has_value());
  EXPECT_THAT(registers, ElementsAre(0x0DFE, 0x0020));
}

TEST(FileRecord, A_client_tells_an_exception_from_a_reply_that_does_not_answer) {
  std::array<std::uint16_t, 2> registers{};
  const auto exception = parse_file_reply(Pdu{0x94, 1}, registers);
  ASSERT_FALSE(exception.has_value());
  EXPECT_EQ(exception.error().exception, Exception::illegal_function);
  for (const Pdu& pdu :
       {Pdu{}, Pdu{0x14}, Pdu{0x14, 4, 3, 6, 0, 1}, Pdu{0x14, 6, 5, 7, 0, 1, 0, 2},
        Pdu{0x14, 6, 4, 6, 0, 1, 0, 2}, Pdu{0x14, 6, 5, 6, 0, 1, 0, 2, 0}, Pdu{0x03, 6, 5, 6, 0, 1, 0, 2}}) {
    const auto parsed = parse_file_reply(pdu, registers);
    ASSERT_FALSE(parsed.has_value());
    EXPECT_FALSE(parsed.error().exception.has_value());
  }
}

TEST(FileRecord, A_byte_count_that_does_not_fit_the_request_is_an_illegal_value) {
  for (const Pdu& pdu : {Pdu{0x14}, Pdu{0x14, 0}, Pdu{0x14, 7}, Pdu{0x14, 6, 6, 0, 1, 0, 0, 0},
                         Pdu{0x14, 8, 6, 0, 1, 0, 0, 0, 1, 0}})
    EXPECT_EQ(file_refusal(pdu), Exception::illegal_data_value);
}

TEST(FileRecord, Records_that_no_file_holds_are_an_illegal_address) {
  EXPECT_EQ(file_refusal(request({{0, 0, 1}})), Exception::illegal_data_address);
  EXPECT_EQ(file_refusal(request({{1, 9999, 2}})), Exception::illegal_data_address);
  EXPECT_EQ(file_refusal(request({{1, 10000, 1}})), Exception::illegal_data_address);
  EXPECT_EQ(file_refusal(request({{1, 0xFFFF, 0xFFFF}})), Exception::illegal_data_address);
  Pdu other_reference = request({{1, 0, 1}});
  other_reference[2] = 5;
  EXPECT_EQ(file_refusal(other_reference), Exception::illegal_data_address);
  EXPECT_TRUE(parse_file_request(request({{0xFFFF, 9999, 1}})).has_value());
}

TEST(FileRecord, A_request_whose_reply_would_not_fit_is_an_illegal_value) {
  EXPECT_TRUE(parse_file_request(request({{1, 0, max_file_registers}})).has_value());
  EXPECT_EQ(file_refusal(request({{1, 0, max_file_registers + 1}})), Exception::illegal_data_value);
  EXPECT_EQ(file_refusal(request({{1, 0, 100}, {1, 0, 100}})), Exception::illegal_data_value);
  EXPECT_EQ(file_refusal(request({{1, 0, 0}})), Exception::illegal_data_value);
}

}  // namespace
}  // namespace coupler::modbus
