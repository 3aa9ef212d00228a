// SPDX-License-Identifier: Apache-2.0
// Read File Record (FC 20, MAP 6.14), both directions.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <tl/expected.hpp>

#include "coupler/base/span.hpp"
#include "coupler/modbus/pdu.hpp"

namespace coupler::modbus {

/// `registers` registers of `file` from `record` on: one group of a request.
struct FileRecord {
  std::uint16_t file = 1;       ///< from 1
  std::uint16_t record = 0;     ///< 0 … 9999
  std::uint16_t registers = 0;  ///< 1 … max_file_registers
};

// The client's side.

constexpr std::size_t file_request_size = 9;

/// Writes the request PDU for one group into `pdu`, which holds at least file_request_size bytes. Returns its
/// size.
std::size_t build_file_request(FileRecord wanted, Span<std::uint8_t> pdu);

/// Takes the registers of the one group out of a reply PDU; it must hold exactly `registers.size()` of them.
tl::expected<void, ReplyError> parse_file_reply(Bytes pdu, Span<std::uint16_t> registers);

// The server's side.

/// The groups of a request that parse_file_request() found valid. A view of the request's PDU.
class FileGroups {
 public:
  FileGroups() = default;
  std::size_t size() const;
  FileRecord operator[](std::size_t i) const;

 private:
  friend tl::expected<FileGroups, Exception> parse_file_request(Bytes pdu);
  explicit FileGroups(Bytes groups) : groups_(groups) {}
  Bytes groups_;
};

/// Every group names records that a file can hold, and the reply has room for all of them.
/// Errors: 03 byte count, no registers, or a reply above 253 bytes; 02 reference type, file 0, records past
/// 9999.
tl::expected<FileGroups, Exception> parse_file_request(Bytes pdu);

/// Builds the reply group by group.
class FileReply {
 public:
  /// `pdu` holds at least max_pdu_size bytes.
  explicit FileReply(Span<std::uint8_t> pdu);
  /// Appends a group and returns where its `2 × registers` bytes go, most significant byte first.
  Span<std::uint8_t> add(std::uint16_t registers);
  /// The size of the PDU so far.
  std::size_t size() const { return size_; }

 private:
  Span<std::uint8_t> pdu_;
  std::size_t size_;
};

}  // namespace coupler::modbus
