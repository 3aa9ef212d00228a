// SPDX-License-Identifier: Apache-2.0
#include "coupler/formats/csv_words.hpp"

#include <algorithm>

#include "coupler/map/loader/scalar.hpp"

namespace coupler::formats {
namespace {

struct Word {
  std::string_view said;  ///< in lower case, letters and digits only
  std::string_view meant;
};

constexpr Word columns[] = {
    {"tag", "name"},
    {"tagname", "name"},
    {"signal", "name"},
    {"signalname", "name"},
    {"variable", "name"},
    {"parameter", "name"},
    {"pointname", "name"},
    {"registername", "name"},
    {"register", "address"},
    {"registeraddress", "address"},
    {"registernumber", "address"},
    {"reg", "address"},
    {"addr", "address"},
    {"modbusaddress", "address"},
    {"registertype", "table"},
    {"area", "table"},
    {"objecttype", "table"},
    {"memoryarea", "table"},
    {"function", "table"},
    {"functioncode", "table"},
    {"fc", "table"},
    {"datatype", "type"},
    {"dtype", "type"},
    {"format", "type"},
    {"uom", "units"},
    {"engineeringunits", "units"},
    {"engineeringunit", "units"},
    {"comment", "description"},
    {"comments", "description"},
    {"remark", "description"},
    {"remarks", "description"},
    {"note", "description"},
    {"notes", "description"},
    {"rw", "access"},
    {"readwrite", "access"},
    {"accesstype", "access"},
    {"permission", "access"},
    {"factor", "scale"},
    {"scalefactor", "scale"},
    {"scaling", "scale"},
    {"multiplier", "scale"},
    {"gain", "scale"},
    {"byteorder", "order"},
    {"slave", "unit"},
    {"slaveid", "unit"},
    {"unitid", "unit"},
    {"minimum", "min"},
    {"maximum", "max"},
};

constexpr Word accesses[] = {
    {"r", "read"},          {"ro", "read"},
    {"readonly", "read"},   {"rd", "read"},
    {"w", "write"},         {"wo", "write"},
    {"writeonly", "write"}, {"wr", "write"},
    {"rw", "read_write"},   {"readwrite", "read_write"},
};

struct TableWord {
  std::string_view said;
  Table meant;
};
constexpr TableWord table_words[] = {
    {"coil", Table::coils},
    {"coils", Table::coils},
    {"co", Table::coils},
    {"do", Table::coils},
    {"0x", Table::coils},
    {"fc1", Table::coils},
    {"digitaloutput", Table::coils},
    {"discreteinput", Table::discrete_inputs},
    {"discreteinputs", Table::discrete_inputs},
    {"discrete", Table::discrete_inputs},
    {"di", Table::discrete_inputs},
    {"1x", Table::discrete_inputs},
    {"fc2", Table::discrete_inputs},
    {"digitalinput", Table::discrete_inputs},
    {"contact", Table::discrete_inputs},
    {"inputstatus", Table::discrete_inputs},
    {"inputregister", Table::input_registers},
    {"inputregisters", Table::input_registers},
    {"ir", Table::input_registers},
    {"3x", Table::input_registers},
    {"fc4", Table::input_registers},
    {"analoginput", Table::input_registers},
    {"holdingregister", Table::holding_registers},
    {"holdingregisters", Table::holding_registers},
    {"holding", Table::holding_registers},
    {"hr", Table::holding_registers},
    {"4x", Table::holding_registers},
    {"fc3", Table::holding_registers},
    {"analogoutput", Table::holding_registers},
};

/// "R/W" -> "rw", "Data type" -> "datatype"
std::string letters_and_digits(std::string_view text) {
  std::string word = loader::lower(text);
  word.erase(std::remove_if(word.begin(), word.end(),
                            [](char c) { return !loader::is_letter(c) && !loader::is_digit(c); }),
             word.end());
  return word;
}

}  // namespace

std::string column_of(std::string_view heading) {
  const std::string word = letters_and_digits(heading);
  for (const auto& [said, meant] : columns)
    if (word == said) return std::string(meant);
  std::string key = loader::lower(heading);
  std::replace(key.begin(), key.end(), ' ', '_');
  return key;
}

std::optional<Table> parse_table(std::string_view text) {
  const std::string word = letters_and_digits(text);
  for (const auto& [said, meant] : table_words)
    if (word == said) return meant;
  return std::nullopt;
}

std::optional<Table> table_of_modicon(std::string_view address) {
  if (address.size() != 5 && address.size() != 6) return std::nullopt;
  switch (address[0]) {
    case '0': return Table::coils;
    case '1': return Table::discrete_inputs;
    case '3': return Table::input_registers;
    case '4': return Table::holding_registers;
    default: return std::nullopt;
  }
}

std::string_view access_of(std::string_view text) {
  const std::string word = letters_and_digits(text);
  for (const auto& [said, meant] : accesses)
    if (word == said) return meant;
  return text;
}

}  // namespace coupler::formats
