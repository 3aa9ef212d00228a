// SPDX-License-Identifier: Apache-2.0
#include "coupler/modbus/file_record.hpp"

#include <cassert>

#include "coupler/modbus/limits.hpp"
#include "coupler/modbus/pdu.hpp"

namespace coupler::modbus {
namespace {

constexpr auto function = static_cast<std::uint8_t>(Function::read_file_record);
constexpr std::uint8_t reference_type = 6;
constexpr std::size_t group_size = 7;  ///< reference type, file, record, length
constexpr std::size_t max_groups = 35;
constexpr std::size_t max_reply_data = 0xF5;  ///< bytes of all groups in a reply

FileRecord group_at(const std::uint8_t* at) { return {get_u16(at + 1), get_u16(at + 3), get_u16(at + 5)}; }

}  // namespace

std::size_t build_file_request(FileRecord wanted, Span<std::uint8_t> pdu) {
  assert(pdu.size() >= file_request_size);
  pdu[0] = function;
  pdu[1] = group_size;
  pdu[2] = reference_type;
  put_u16(&pdu[3], wanted.file);
  put_u16(&pdu[5], wanted.record);
  put_u16(&pdu[7], wanted.registers);
  return file_request_size;
}

tl::expected<void, ReplyError> parse_file_reply(Bytes pdu, Span<std::uint16_t> registers) {
  // function, data length, then the group: its length, reference type, registers
  const std::size_t data = 2 * registers.size();
  if (pdu.size() != 4 + data || pdu[0] != function || pdu[1] != 2 + data || pdu[2] != 1 + data ||
      pdu[3] != reference_type)
    return tl::unexpected(reply_error(function, pdu));
  for (std::size_t i = 0; i < registers.size(); ++i) registers[i] = get_u16(&pdu[4 + 2 * i]);
  return {};
}

std::size_t FileGroups::size() const { return groups_.size() / group_size; }

FileRecord FileGroups::operator[](std::size_t i) const { return group_at(&groups_[i * group_size]); }

tl::expected<FileGroups, Exception> parse_file_request(Bytes pdu) {
  if (pdu.size() < 2 || pdu[1] != pdu.size() - 2 || pdu[1] == 0 || pdu[1] % group_size != 0 ||
      pdu[1] > max_groups * group_size)
    return tl::unexpected(Exception::illegal_data_value);

  const Bytes groups = pdu.from(2);
  std::size_t reply = 2;
  for (std::size_t at = 0; at < groups.size(); at += group_size) {
    const FileRecord group = group_at(&groups[at]);
    if (group.registers == 0) return tl::unexpected(Exception::illegal_data_value);
    if (groups[at] != reference_type || group.file == 0 ||
        std::uint32_t{group.record} + group.registers > records_per_file)
      return tl::unexpected(Exception::illegal_data_address);
    reply += 2 + std::size_t{2} * group.registers;
  }
  if (reply > 2 + max_reply_data) return tl::unexpected(Exception::illegal_data_value);
  return FileGroups(groups);
}

FileReply::FileReply(Span<std::uint8_t> pdu) : pdu_(pdu), size_(2) {
  assert(pdu.size() >= max_pdu_size);
  pdu_[0] = function;
  pdu_[1] = 0;
}

Span<std::uint8_t> FileReply::add(std::uint16_t registers) {
  const std::size_t data = std::size_t{2} * registers;
  assert(size_ + 2 + data <= max_pdu_size);
  pdu_[size_] = static_cast<std::uint8_t>(1 + data);
  pdu_[size_ + 1] = reference_type;
  const auto place = pdu_.sub(size_ + 2, data);
  size_ += 2 + data;
  pdu_[1] = static_cast<std::uint8_t>(size_ - 2);
  return place;
}

}  // namespace coupler::modbus
