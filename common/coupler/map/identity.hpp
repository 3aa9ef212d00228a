// SPDX-License-Identifier: Apache-2.0
// How a node tells what it is: a few input registers and the map as a file. The driver reads them at every
// connect. docs/identity.md holds the layout as a table.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string_view>

#include "coupler/base/span.hpp"
#include "coupler/map/map.hpp"
#include "coupler/modbus/file_record.hpp"
#include "coupler/modbus/limits.hpp"
#include "coupler/modbus/range.hpp"

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
  at_statistics = 13,      ///< from here: 32-bit counters, most significant register first: `counters`
  at_uptime = 13,          ///< seconds
  at_further = 45,    ///< how many registers of further fields follow; the first nodes do not have this one
  at_serial = 46,     ///< of the machine, a hash, 4 registers, most significant first; 0: unknown
  at_hostname = 50,   ///< 32 registers, ASCII, two characters each, the first one high; zeros behind it
  at_functions = 82,  ///< function codes of our own that the node answers: Functions
  at_watchdog_timeout = 83,  ///< ms, 2 registers, most significant first; 0: it has no watchdog
  size = 85,
};

constexpr std::uint32_t magic = 0x4F43504C;  // "OCPL"
constexpr std::uint16_t layout = 1;

/// Registers that the driver reads at connect: up to the statistics.
constexpr std::uint16_t head_size = at_statistics;
/// Registers that every node has. A driver takes any other layout version for a foreign coupler, so fields
/// are only ever appended, and a reader asks first how many there are and ignores those that it does not
/// know.
constexpr std::uint16_t report_size = at_further;
/// Registers of the further fields that this program knows.
constexpr std::uint16_t further_size = size - at_serial;

struct Head {
  std::uint64_t fingerprint = 0;
  std::uint32_t map_size = 0;
  std::uint32_t map_crc = 0;
};

/// Returns what a node of this map says of itself.
Head head_of(const Map& map);

/// Registers at_magic … at_map_crc + 1; the rest of the area is the node's own.
void write_head(const Head& head, std::uint16_t* area);

/// nullopt if the registers do not begin with the magic and a layout that this program knows: a foreign
/// coupler.
std::optional<Head> read_head(const std::array<std::uint16_t, head_size>& area);

/// The names of the values of at_watchdog_state.
constexpr std::array<std::string_view, 4> watchdog_states{"not configured", "idle", "armed", "expired"};

/// The counts of a node since its start. They wrap.
struct Counts {
  std::uint32_t requests = 0;       ///< answered, exceptions included
  std::uint32_t exceptions = 0;     ///< of those
  std::uint32_t exceptions_01 = 0;  ///< of those, by code
  std::uint32_t exceptions_02 = 0;
  std::uint32_t exceptions_03 = 0;
  std::uint32_t exceptions_04 = 0;
  std::uint32_t hardware_errors = 0;  ///< requests that a line or channel failed, exception 04
  std::uint32_t events_lost = 0;      ///< edges of counted inputs that were not seen, at least
  std::uint32_t watchdog_trips = 0;   ///< outputs went to their safe state since no client fed the watchdog
  std::uint32_t foreign_units = 0;    ///< requests for another unit id, not answered
  std::uint32_t connections = 0;      ///< accepted
  std::uint32_t refusals = 0;         ///< connections of clients that may not connect
  std::uint32_t evictions = 0;        ///< connections closed to make room for new ones
  std::uint32_t bad_frames = 0;       ///< connections closed for what they sent
  std::uint32_t timeouts = 0;         ///< connections closed for what they did not send or read in time
};

/// A counter, and its place in the area.
struct Counter {
  std::uint16_t at;
  std::uint32_t Counts::*count;
  std::string_view key;   ///< for programs
  std::string_view text;  ///< for people
};
constexpr std::array<Counter, 15> counters{{
    {15, &Counts::requests, "requests", "requests answered"},
    {17, &Counts::exceptions, "exceptions", "of these, with an exception"},
    {27, &Counts::exceptions_01, "exceptions_01", "exception 01 (illegal function)"},
    {29, &Counts::exceptions_02, "exceptions_02", "exception 02 (illegal data address)"},
    {31, &Counts::exceptions_03, "exceptions_03", "exception 03 (illegal data value)"},
    {33, &Counts::exceptions_04, "exceptions_04", "exception 04 (server device failure)"},
    {39, &Counts::foreign_units, "foreign_units", "requests for another unit id"},
    {19, &Counts::connections, "connections", "connections accepted"},
    {35, &Counts::refusals, "connections_refused", "connections refused by 'allow'"},
    {37, &Counts::evictions, "connections_evicted", "connections closed to make room"},
    {41, &Counts::bad_frames, "connections_bad_frames", "connections closed for a bad frame"},
    {43, &Counts::timeouts, "connections_timed_out", "connections closed by a timeout"},
    {21, &Counts::hardware_errors, "hardware_errors", "hardware errors"},
    {25, &Counts::events_lost, "events_lost", "events lost"},
    {23, &Counts::watchdog_trips, "watchdog_trips", "times the watchdog expired"},
}};
/// The counts of exceptions, by code: 01, 02, 03, 04.
constexpr std::array<std::uint32_t Counts::*, 4> exceptions_of{
    {&Counts::exceptions_01, &Counts::exceptions_02, &Counts::exceptions_03, &Counts::exceptions_04}};

/// The part of the identity that every node has.
struct Report {
  Head head;
  std::uint16_t watchdog_state = 0;
  std::uint16_t watchdog_left = 0;  ///< ms
  bool has_statistics = false;      ///< the rest is known: not every client may read it
  std::uint32_t uptime = 0;         ///< s
  Counts counts;
};

/// nullopt: as read_head().
std::optional<Report> read_report(const std::array<std::uint16_t, report_size>& area);
/// The same without the statistics.
std::optional<Report> read_report_head(const std::array<std::uint16_t, head_size>& area);

/// The machine that a node runs on. It tells two nodes with one map apart.
struct Machine {
  std::uint64_t serial = 0;         ///< a hash; 0: unknown
  std::array<char, 64> hostname{};  ///< zeros behind it, if it is shorter; empty: unknown
};

/// The capabilities of the node that Modbus does not tell. An older node has none of them.
struct Functions {
  static constexpr std::uint16_t tells_changes_bit = 1;      ///< FC 65
  static constexpr std::uint16_t schedules_outputs_bit = 2;  ///< FC 66
  static constexpr std::uint16_t has_field_side_bit = 4;     ///< coupler/map/field_side.hpp
  bool tells_changes = false;
  bool schedules_outputs = false;
  bool has_field_side = false;
};

/// The further fields.
struct Further {
  Machine machine;
  Functions functions;
  std::uint32_t watchdog_timeout = 0;  ///< ms; 0: no watchdog, or an older node, which does not say
};

/// A name that is too long is cut off.
Machine machine_of(std::string_view hostname, std::uint64_t serial);
std::string_view hostname_of(const Machine& machine);

/// Registers at_further … size.
void write_further(const Further& further, std::uint16_t* area);

/// `further` is from at_serial on, as many registers as the node has; what it does not have stays unknown.
Further read_further(Span<const std::uint16_t> further);

/// The place of a piece of the map's text, for FC 20: two bytes a record, most significant first,
/// records_per_file records a file, files from 1 upward. An odd last byte is followed by a zero.
using modbus::FileRecord;

/// The record of the `first`-th register of the text (first = byte offset / 2), as many registers as one
/// request may carry without leaving the file or the text of `map_size` bytes.
FileRecord record_at(std::uint32_t first, std::uint32_t map_size);

}  // namespace coupler::identity
