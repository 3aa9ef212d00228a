// SPDX-License-Identifier: Apache-2.0
// How a node tells what it is: a few input registers and the map as a file. The driver reads them at every
// connect. docs/identity.md holds the layout as a table.
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "common/map/map.hpp"
#include "common/modbus/file_record.hpp"
#include "common/modbus/limits.hpp"
#include "common/modbus/range.hpp"

namespace coupler::identity {

/// Input registers 0xFF00 … 0xFFFF and holding register 0xFF00 … 0xFFFF belong to the node.
constexpr modbus::Range reserved = modbus::Range::of(0xFF00, 0x100);

/// A node whose watchdog recovers manually maps this holding register: the code resets it, reading gives 0.
constexpr modbus::Range watchdog_reset = modbus::Range::of(reserved.start(), 1);
constexpr std::uint16_t watchdog_reset_code = 0xAA55;

/// Places in the area, relative to reserved.start().
enum : std::uint16_t {
  at_magic = 0,            ///< "OCPL", 2 registers
  at_layout = 2,           ///< layout version, now 1
  at_fingerprint = 3,      ///< 4 registers, most significant first
  at_map_size = 7,         ///< bytes, 2 registers, most significant first
  at_map_crc = 9,          ///< CRC-32 of the map, 2 registers
  at_watchdog_state = 11,  ///< 0 not configured, 1 idle, 2 armed, 3 expired
  at_watchdog_left = 12,   ///< remaining time, ms (65535: that or more)
  at_statistics = 13,      ///< from here: 32-bit counters, most significant register first
  at_uptime = 13,          ///< seconds
  at_requests = 15,
  at_exceptions = 17,
  at_connections = 19,  ///< accepted since start
  at_hardware_errors = 21,
  at_watchdog_trips = 23,
  at_events_lost = 25,    ///< edges of counted inputs, at least
  at_exceptions_of = 27,  ///< by code: 01, 02, 03, 04
  at_refusals = 35,       ///< connections of clients that may not connect
  at_evictions = 37,      ///< connections closed to make room
  at_foreign_units = 39,  ///< requests for another unit id
  at_bad_frames = 41,     ///< connections closed for what they sent
  at_timeouts = 43,       ///< connections closed for what they did not send or read in time
  size = 45,
};

constexpr std::uint32_t magic = 0x4F43504C;  // "OCPL"
constexpr std::uint16_t layout = 1;

/// Registers that the driver reads at connect: up to the statistics.
constexpr std::uint16_t head_size = at_statistics;

struct Head {
  std::uint64_t fingerprint = 0;
  std::uint32_t map_size = 0;
  std::uint32_t map_crc = 0;
};

/// What a node of this map says of itself.
Head head_of(const Map& map);

/// Registers at_magic … at_map_crc + 1; the rest of the area is the node's own.
void write_head(const Head& head, std::uint16_t* area);

/// nullopt if the registers do not begin with the magic and a layout that this program knows: a foreign
/// coupler.
std::optional<Head> read_head(const std::array<std::uint16_t, head_size>& area);

/// Where a piece of the map's text is, for FC 20: two bytes a record, most significant first,
/// records_per_file records a file, files from 1 upward; an odd last byte is followed by a zero.
using modbus::FileRecord;

/// The record of the `first`-th register of the text (first = byte offset / 2), as many registers as one
/// request may carry without leaving the file or the text of `map_size` bytes.
FileRecord record_at(std::uint32_t first, std::uint32_t map_size);

}  // namespace coupler::identity
