// SPDX-License-Identifier: Apache-2.0
#include "coupler/tools/probe_report.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "coupler/host/scan/identification.hpp"
#include "coupler/host/scan/texts.hpp"
#include "coupler/map/fields.hpp"
#include "coupler/map/fingerprint.hpp"
#include "coupler/map/node_address.hpp"
#include "coupler/map/printable.hpp"
#include "coupler/tools/place_argument.hpp"

namespace coupler::tools {
namespace {

using scan::Findings;
using scan::TableFindings;
using Seen = TableFindings::Seen;

constexpr std::size_t most_ranges = 24;
constexpr std::size_t most_candidates = 6;

/// "10.0.0.7:502/255", to be given to a command, with what is known of a serial line.
std::string place(Connection connection, std::uint8_t unit) {
  connection.unit = unit;
  const Serial& line = connection.serial;
  if (line.present())
    return printable(
        fmt::format("{}/{} --baud {} --parity {}", line.device, unit, line.baud, to_string(line.parity)));
  return printable(as_argument(node_address_text(connection)));
}

std::string units_text(const Findings& findings, const Connection& connection) {
  std::string answer;
  for (const std::uint8_t unit : findings.units)
    answer += fmt::format("{}{}", answer.empty() ? "" : ", ", unit);
  const Serial& line = connection.serial;
  std::string text = fmt::format("units that answer{}: {}\n",
                                 line.present() ? " at " + rate_and_parity(line) : std::string(), answer);
  if (findings.units.size() > 1)
    text += fmt::format("the rest is about unit {}; for another one: coupler probe {}\n", *findings.unit,
                        place(connection, findings.units[1]));
  return text;
}

std::string identification_text(const Findings& findings) {
  std::string text;
  for (const auto& [id, value] : findings.identification)
    text += fmt::format("  {:<20} {}\n", scan::object_name(id), printable(value));
  text = text.empty() ? "identification: none (FC 43/14)\n" : "identification:\n" + text;
  if (findings.node)
    text += fmt::format("an OpenCoupler node, which serves its map: fingerprint {}\n",
                        fingerprint_text(findings.node->fingerprint));
  if (findings.recognition)
    text += fmt::format("a {}, by its own registers: {}; `preset: {}`\n", findings.recognition->kind,
                        channels_text(*findings.recognition), findings.recognition->preset);
  return text;
}

std::string ranges_text(const std::vector<modbus::Range>& ranges) {
  std::string text;
  for (std::size_t i = 0; i < std::min(ranges.size(), most_ranges); ++i) {
    text += i == 0 ? "" : ", ";
    text += ranges[i].count() == 1 ? fmt::format("{}", ranges[i].start())
                                   : fmt::format("{} … {}", ranges[i].start(), ranges[i].last());
  }
  if (ranges.size() > most_ranges) text += fmt::format(" and {} more ranges", ranges.size() - most_ranges);
  return text;
}

std::string table_text(const TableFindings& table) {
  const std::uint32_t readable = table.count(Seen::readable);
  const std::uint32_t untried = table.count(Seen::not_asked);
  std::string text = fmt::format("{}:\n", to_string(table.table()));
  if (table.absent) return text + "  none: the device has no function that reads them (exception 01)\n";
  text += fmt::format("  readable: {}\n", readable == 0 ? "none" : ranges_text(table.readable()));
  text += fmt::format("  of {} … {}: {} readable, {} refused, {} not tried\n", table.window().start(),
                      table.window().last(), readable, table.count(Seen::refused), untried);
  for (const std::uint32_t seam : table.seams())
    text += fmt::format("  no read may cross {}: read from there, or up to there\n", seam);
  if (table.gave_up_at)
    text += fmt::format("  stopped at {} after {} time-outs; continue with --from {}\n", *table.gave_up_at,
                        scan::most_timeouts, *table.gave_up_at);
  return text;
}

std::string limit_text(const scan::Largest& largest, std::string_view what) {
  if (!largest.is_limited) return {};
  return fmt::format("most {0} in one read: {1}; write `limits: {{read_{0}: {1}}}`\n", what, largest.count);
}

std::string match_text(const scan::Match& match) {
  std::string text =
      fmt::format("known value {}{}{} ± {:.6g}:\n", match.known.name, match.known.name.empty() ? "" : " = ",
                  match.known.value, match.known.tolerance);
  if (match.candidates.empty()) return text + "  not found in the registers that were read\n";
  for (std::size_t i = 0; i < std::min(match.candidates.size(), most_candidates); ++i) {
    const scan::Candidate& candidate = match.candidates[i];
    text += fmt::format("  {:<18} {:<52} {}\n", to_string(candidate.table), scan::point_text(candidate, true),
                        scan::value_text(candidate));
  }
  if (match.candidates.size() > most_candidates)
    text += fmt::format("  and {} less likely places\n", match.candidates.size() - most_candidates);
  return text;
}

std::string texts_text(const Findings& findings) {
  const std::vector<scan::FoundText> texts = scan::find_texts(findings.tables);
  std::string text = texts.empty() ? "" : "texts:\n";
  for (std::size_t i = 0; i < std::min(texts.size(), most_ranges); ++i)
    text += fmt::format("  {:<18} {:<52} {}\n", to_string(texts[i].table), scan::point_text(texts[i]),
                        scan::value_text(texts[i]));
  if (texts.size() > most_ranges) text += fmt::format("  and {} more texts\n", texts.size() - most_ranges);
  return text;
}

std::string orders_text(const std::vector<scan::Match>& matches) {
  const auto order = scan::common_order(matches);
  if (!order) return {};
  return fmt::format(
      "order of the device: {}; write `byteorder_reverse: {}`, `wordorder_reverse: {}`, or `order` at each "
      "point\n",
      to_string(*order, false), codec::bytes_swapped(*order), !codec::words_reversed(*order));
}

/// Returns where else something may be, for a device that shows nothing.
std::string where_to_look(const Findings& findings, const scan::Task& task, const Connection& connection,
                          bool untried) {
  std::vector<std::string> places;
  if (findings.units.size() > 1)
    places.push_back(fmt::format("another unit, as {}", place(connection, findings.units[1])));
  else
    places.push_back("another unit, as --units 1-247");
  if (task.window.start() > 0 || task.window.end() <= 65535)
    places.push_back("all addresses, by --from 0 --to 65535");
  if (untried && task.stride > 1) places.push_back("each address, by --stride 1");
  return fmt::format("{}", fmt::join(places, "; "));
}

}  // namespace

bool shows_nothing(const Findings& findings) {
  return std::all_of(findings.tables.begin(), findings.tables.end(),
                     [](const TableFindings& table) { return table.count(Seen::readable) == 0; });
}

std::string probe_report(const Findings& findings, const scan::Task& task, const Connection& connection,
                         const std::vector<scan::Match>& matches) {
  if (findings.node && findings.tables.empty()) return identification_text(findings);
  std::string text = units_text(findings, connection) + identification_text(findings);
  bool untried = false;
  for (const TableFindings& table : findings.tables) {
    text += table_text(table);
    untried |= !table.absent && table.count(Seen::not_asked) > 0;
  }
  text += limit_text(findings.largest.registers, "registers");
  text += limit_text(findings.largest.bits, "bits");
  for (const scan::Match& match : matches) text += match_text(match);
  text += orders_text(matches);
  text += texts_text(findings);
  text += fmt::format("requests: {}\n", findings.requests);
  for (const std::string& failure : findings.failures)
    text += fmt::format("  without an answer: {}\n", printable(failure));
  if (!findings.is_complete) text += "ended early: there may be more\n";
  if (findings.is_complete && shows_nothing(findings))
    return text + fmt::format("the device shows nothing: no address from {} to {} can be read; try {}\n",
                              task.window.start(), task.window.last(),
                              where_to_look(findings, task, connection, untried));
  if (untried && task.stride > 1)
    text += fmt::format("not tried: where blocks are refused, only one address in {}; --stride 1 tries all\n",
                        task.stride);
  return text;
}

}  // namespace coupler::tools
