// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/scan/draft.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "coupler/host/scan/identification.hpp"
#include "coupler/host/scan/texts.hpp"
#include "coupler/map/node_address.hpp"
#include "coupler/map/printable.hpp"

namespace coupler::scan {
namespace {

using modbus::Range;
using Seen = TableFindings::Seen;

/// Ranges up to this long become a point for each address.
constexpr std::uint32_t longest_of_singles = 4;
constexpr std::uint32_t most_bits_in_comment = 32;
constexpr std::uint32_t most_registers_in_comment = 8;

/// A value that is known to be in some registers.
struct Named {
  std::string name;
  Table table;
  Range range;
  std::string options;  ///< as point_text() has them
  std::string comment;
};

bool is_taken(const std::vector<Named>& named, Table table, Range range) {
  return std::any_of(named.begin(), named.end(),
                     [&](const Named& other) { return other.table == table && other.range.overlaps(range); });
}

/// Returns whether the order of the device gives the candidate already.
bool is_given(const Candidate& candidate, std::optional<codec::Order> order) {
  const std::vector<Candidate> alone{candidate};
  return order && choose(alone, order) != nullptr;
}

std::vector<Named> place(const Findings& findings, const std::vector<Match>& matches,
                         std::optional<codec::Order> order) {
  std::vector<Named> named;
  for (const Match& match : matches) {
    const Candidate* best = choose(match.candidates, order);
    if (best == nullptr) best = choose(match.candidates, std::nullopt);
    if (best == nullptr || is_taken(named, best->table, best->range)) continue;
    const auto number = static_cast<std::size_t>(&match - matches.data()) + 1;
    named.push_back({match.known.name.empty() ? fmt::format("value_{}", number) : match.known.name,
                     best->table, best->range, point_text(*best, !is_given(*best, order)),
                     value_text(*best)});
  }
  for (const FoundText& text : find_texts(findings.tables))
    if (!is_taken(named, text.table, text.range))
      named.push_back({fmt::format("{}_text_{}", to_string(text.table), text.range.start()), text.table,
                       text.range, point_text(text), value_text(text)});
  return named;
}

std::string values_text(const TableFindings& table, Range range) {
  std::string text;
  const bool bits = holds_bits(table.table());
  const std::uint32_t most = bits ? most_bits_in_comment : most_registers_in_comment;
  for (std::uint32_t i = 0; i < std::min(range.count(), most); ++i)
    text += fmt::format("{}{}", bits || i == 0 ? "" : " ", table.value(range.start() + i));
  return range.count() > most ? text + " …" : text;
}

class Writer {
 public:
  Writer(const Findings& findings, const std::vector<Match>& matches)
      : findings_(findings), order_(common_order(matches)), named_(place(findings, matches, order_)) {}

  std::string write(const Connection& connection) {
    head(connection);
    device(connection);
    bool is_empty = true;
    for (const TableFindings& table : findings_.tables) is_empty &= table.count(Seen::readable) == 0;
    text_ += is_empty ? "mapping: {}\n" : "mapping:\n";
    for (const TableFindings& table : findings_.tables)
      if (table.count(Seen::readable) > 0) points_of(table);
    return std::move(text_);
  }

 private:
  void head(const Connection& connection) {
    text_ += fmt::format("# A draft by `coupler probe` of {}, unit {}.\n", printable(place_text(connection)),
                         connection.unit);
    for (const auto& [id, value] : findings_.identification)
      text_ += fmt::format("# {}: {}\n", object_name(id), printable(value));
    for (const TableFindings& table : findings_.tables)
      text_ += fmt::format("# {} {} … {}: {} readable, {} refused, {} not tried\n", to_string(table.table()),
                           table.window().start(), table.window().last(), table.count(Seen::readable),
                           table.count(Seen::refused), table.count(Seen::not_asked));
    if (!findings_.is_complete) text_ += "# The scan was ended early: more may be readable.\n";
    text_ +=
        "# Comments show the values that were read. All points are read-only: set `access: read_write` for "
        "those "
        "that you know.\n";
  }

  void device(const Connection& connection) {
    text_ += "name: device\n" + connection_text(connection);
    limits();
    if (order_)
      text_ += fmt::format("byteorder_reverse: {}\nwordorder_reverse: {}   # order {}: the known values\n",
                           codec::bytes_swapped(*order_), !codec::words_reversed(*order_),
                           to_string(*order_, false));
    std::string holes;
    for (const TableFindings& table : findings_.tables)
      for (const Range hole : table.holes())
        holes += fmt::format("  - {{table: {}, from: {}, to: {}}}\n", to_string(table.table()), hole.start(),
                             hole.last());
    if (!holes.empty()) text_ += "unreadable:\n" + holes;
  }

  void limits() {
    std::string limits;
    const LargestReads& largest = findings_.largest;
    if (largest.registers.is_limited) limits = fmt::format("read_registers: {}", largest.registers.count);
    if (largest.bits.is_limited)
      limits += fmt::format("{}read_bits: {}", limits.empty() ? "" : ", ", largest.bits.count);
    if (!limits.empty()) text_ += fmt::format("limits: {{{}}}   # one more is refused\n", limits);
  }

  void points_of(const TableFindings& table) {
    text_ += fmt::format("  {}:\n", to_string(table.table()));
    for (const Range range : table.readable()) {
      std::uint32_t start = range.start();
      for (const Named* next = first_named(table, range, start); next != nullptr;
           next = first_named(table, range, start)) {
        fill(table, start, next->range.start());
        named(table, *next);
        start = next->range.end();
      }
      fill(table, start, range.end());
    }
  }

  const Named* first_named(const TableFindings& table, Range within, std::uint32_t from) const {
    const Named* first = nullptr;
    for (const Named& named : named_) {
      const bool is_here =
          named.table == table.table() && within.contains(named.range) && named.range.start() >= from;
      if (is_here && (first == nullptr || named.range.start() < first->range.start())) first = &named;
    }
    return first;
  }

  void named(const TableFindings& table, const Named& named) {
    std::string options = named.options;
    options.insert(options.size() - 1, ", access: read");
    line(table, named.range, named.name, options, named.comment);
  }

  /// Points for [start, end).
  void fill(const TableFindings& table, std::uint32_t start, std::uint32_t end) {
    const bool bits = holds_bits(table.table());
    const std::uint32_t most = end - start <= longest_of_singles
                                   ? 1
                                   : (bits ? findings_.largest.bits : findings_.largest.registers).count;
    while (start < end) {
      const Range range = Range::of(start, std::min(most, end - start));
      std::string options = fmt::format("{{address: {}", start);
      if (!bits) options += ", type: UINT";
      if (range.count() > 1) options += fmt::format(", count: {}", range.count());
      const std::string name = range.count() == 1
                                   ? fmt::format("{}_{}", to_string(table.table()), start)
                                   : fmt::format("{}_{}_{}", to_string(table.table()), start, range.last());
      line(table, range, name, options + ", access: read}", values_text(table, range));
      start = range.end();
    }
  }

  void line(const TableFindings& table, Range range, std::string_view name, std::string_view options,
            std::string_view comment) {
    const bool at_seam = table.seams().count(range.start()) != 0;
    text_ += fmt::format("    {}: {}   # {}{}\n", name, options, comment,
                         at_seam ? "; no read may cross its start" : "");
  }

  const Findings& findings_;
  std::optional<codec::Order> order_;
  std::vector<Named> named_;
  std::string text_;
};

}  // namespace

std::string point_text(const Candidate& candidate, bool with_order) {
  std::string text =
      fmt::format("{{address: {}, type: {}", candidate.range.start(), to_string(candidate.type));
  if (with_order)
    text += fmt::format(", order: {}", to_string(candidate.order, candidate.range.count() == 1));
  if (candidate.divisor != 1) text += fmt::format(", scale: {}", candidate.divisor == 10 ? "0.1" : "0.01");
  return text + "}";
}

std::string value_text(const Candidate& candidate) {
  if (candidate.type == codec::Type::REAL) return fmt::format("{}", static_cast<float>(candidate.value));
  return fmt::format("{}", candidate.value);
}

std::string connection_text(const Connection& connection) {
  const Serial& line = connection.serial;
  const std::string unit = fmt::format("unit: {}\n", connection.unit);
  if (line.present())
    return fmt::format("serial: {{device: \"{}\", baud: {}, parity: {}, stop_bits: {}{}}}\n", line.device,
                       line.baud, to_string(line.parity), line.stop_bits, line.rs485 ? ", rs485: true" : "") +
           unit;
  return fmt::format("address: \"{}\"\nport: {}\n{}", connection.address, connection.port,
                     connection.is_rtu() ? "framing: rtu\n" : "") +
         unit;
}

std::string draft_map(const Findings& findings, const Connection& connection,
                      const std::vector<Match>& matches) {
  return Writer(findings, matches).write(connection);
}

}  // namespace coupler::scan
