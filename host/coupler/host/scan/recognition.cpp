// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/scan/recognition.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "coupler/host/scan/draft.hpp"
#include "coupler/map/node_address.hpp"
#include "coupler/map/printable.hpp"

namespace coupler::scan {
namespace {

/// WAGO 750. Each is asked for alone: the manual gives most of them the length 1. Sources:
/// manualshelf.com/manual/quest-controls/bacnet-t-stat/technical-data-english/page-232.html (the table),
/// page-237.html and page-238.html (lengths of the process image), page-243.html (constants);
/// manualarchiveguide.com/manuals/WAGO-750-Series-Manual-4703874?page=126 (the nameplate).
namespace wago {

constexpr std::uint16_t at_1234 = 0x2002;
constexpr std::uint16_t at_aaaa = 0x2003;
constexpr std::uint16_t at_series = 0x2011;
constexpr std::uint16_t at_item = 0x2012;
constexpr std::uint16_t at_analogue_outputs = 0x1022;  ///< in bits, as the next three
constexpr std::uint16_t at_analogue_inputs = 0x1023;
constexpr std::uint16_t at_outputs = 0x1024;
constexpr std::uint16_t at_inputs = 0x1025;

/// From there on the same addresses read outputs back; what is beyond stands elsewhere.
constexpr std::uint32_t most_bits = 512;
constexpr std::uint32_t most_registers = 256;

/// Fieldbus couplers (750-3xx) and controllers of their kind (750-8xx). A PFC200 (8202) has the same
/// constants, but its program decides what is in its registers, and its lengths mean something else.
bool has_preset(std::uint16_t item) { return (item >= 300 && item < 400) || (item >= 800 && item < 900); }

}  // namespace wago

/// Nothing more is asked for after a register that cannot be read.
class Registers {
 public:
  explicit Registers(Prober& prober) : prober_(prober) {}

  std::uint16_t operator[](std::uint16_t address) {
    std::uint16_t value = 0;
    if (are_there_)
      are_there_ = prober_.read(Table::holding_registers, modbus::Range::of(address, 1), &value).is_given();
    return are_there_ ? value : std::uint16_t{0};
  }
  bool are_there() const { return are_there_; }

 private:
  Prober& prober_;
  bool are_there_ = true;
};

/// `count`, or `most` if that is less.
std::uint32_t within(std::uint32_t count, std::uint32_t most, bool& is_cut) {
  is_cut |= count > most;
  return std::min(count, most);
}

std::optional<Recognition> recognise_wago(Registers registers) {
  if (registers[wago::at_1234] != 0x1234 || registers[wago::at_aaaa] != 0xAAAA) return std::nullopt;
  const std::uint16_t series = registers[wago::at_series];
  const std::uint16_t item = registers[wago::at_item];
  if (series != 750 || !wago::has_preset(item)) return std::nullopt;
  Recognition found{fmt::format("WAGO {}-{}", series, item), fmt::format("wago_{}_{}", series, item),
                    "wago_750"};
  const auto words = [](std::uint32_t bits) { return (bits + 15) / 16; };
  found.analogue_outputs =
      within(words(registers[wago::at_analogue_outputs]), wago::most_registers, found.is_cut);
  found.analogue_inputs =
      within(words(registers[wago::at_analogue_inputs]), wago::most_registers, found.is_cut);
  found.outputs = within(registers[wago::at_outputs], wago::most_bits, found.is_cut);
  found.inputs = within(registers[wago::at_inputs], wago::most_bits, found.is_cut);
  if (!registers.are_there()) return std::nullopt;
  return found;
}

std::string points_text(Table table, std::string_view name, std::uint32_t count) {
  if (count == 0) return {};
  std::string text = fmt::format("  {}:\n", to_string(table));
  for (std::uint32_t i = 0; i < count; ++i)
    text += fmt::format("    {}_{}: {{address: {}{}}}\n", name, i + 1, i,
                        holds_bits(table) ? "" : ", type: UINT");
  return text;
}

}  // namespace

std::optional<Recognition> recognise(Prober& prober) {
  auto found = recognise_wago(Registers(prober));
  if (found && found->inputs + found->outputs + found->analogue_inputs + found->analogue_outputs == 0)
    return std::nullopt;
  return found;
}

std::string channels_text(const Recognition& recognition) {
  std::string text;
  const auto add = [&](std::uint32_t count, std::string_view what) {
    if (count > 0)
      text += fmt::format("{}{} {}{}", text.empty() ? "" : ", ", count, what, count == 1 ? "" : "s");
  };
  add(recognition.inputs, "input");
  add(recognition.outputs, "output");
  add(recognition.analogue_inputs, "analogue input");
  add(recognition.analogue_outputs, "analogue output");
  return text;
}

std::string recognised_map(const Recognition& recognition, const Connection& connection) {
  std::string text = fmt::format("# A draft by `coupler probe` of {}, unit {}: a {}, by its own registers.\n",
                                 printable(place_text(connection)), connection.unit, recognition.kind);
  text +=
      "# A point for each bit and each register of its process image, in the order of its terminals:\n"
      "# some are spare bits of a terminal or its status. Give those that you use their names.\n";
  if (recognition.is_cut) text += "# It has more, beyond the addresses that the preset knows.\n";
  text += fmt::format("name: {}\npreset: {}\n", recognition.name, recognition.preset);
  text += connection_text(connection) + "mapping:\n";
  text += points_text(Table::coils, "output", recognition.outputs);
  text += points_text(Table::discrete_inputs, "input", recognition.inputs);
  text += points_text(Table::input_registers, "analogue_input", recognition.analogue_inputs);
  text += points_text(Table::holding_registers, "analogue_output", recognition.analogue_outputs);
  return text;
}

}  // namespace coupler::scan
