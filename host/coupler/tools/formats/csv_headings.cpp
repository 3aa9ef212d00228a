// SPDX-License-Identifier: Apache-2.0
#include "coupler/tools/formats/csv_headings.hpp"

#include <algorithm>

#include "coupler/map/loader/scalar.hpp"

namespace coupler::formats {
namespace {

struct Heading {
  std::string_view said;  ///< in lower case, letters and digits only
  std::string_view key;
  Reading reading = Reading::plain;
};

constexpr Heading headings[] = {
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
    {"adresse", "address"},
    {"registeradresse", "address"},
    {"registernummer", "address"},
    {"registertype", "table"},
    {"area", "table"},
    {"objecttype", "table"},
    {"memoryarea", "table"},
    {"function", "table", Reading::function_codes},
    {"functioncode", "table", Reading::function_codes},
    {"functioncodes", "table", Reading::function_codes},
    {"modbusfunction", "table", Reading::function_codes},
    {"fc", "table", Reading::function_codes},
    {"datatype", "type"},
    {"dtype", "type"},
    {"format", "type"},
    {"datentyp", "type"},
    {"uom", "units"},
    {"engineeringunits", "units"},
    {"engineeringunit", "units"},
    {"engunits", "units"},
    {"engunit", "units"},
    {"euunits", "units"},
    {"einheit", "units"},
    {"scaledunits", "units", Reading::scaled_units},
    {"dividedunits", "units", Reading::divided_units},
    {"comment", "description"},
    {"comments", "description"},
    {"remark", "description"},
    {"remarks", "description"},
    {"note", "description"},
    {"notes", "description"},
    {"beschreibung", "description"},
    {"kommentar", "description"},
    {"bemerkung", "description"},
    {"rw", "access"},
    {"readwrite", "access"},
    {"accesstype", "access"},
    {"permission", "access"},
    {"clientaccess", "access"},
    {"accessmode", "access"},
    {"accessrights", "access"},
    {"lesenschreiben", "access"},
    {"zugriff", "access"},
    {"writable", "access", Reading::may_be_written},
    {"writeable", "access", Reading::may_be_written},
    {"writeenable", "access", Reading::may_be_written},
    {"write", "access", Reading::may_be_written},
    {"canwrite", "access", Reading::may_be_written},
    {"schreibbar", "access", Reading::may_be_written},
    {"readonly", "access", Reading::may_not_be_written},
    {"ro", "access", Reading::may_not_be_written},
    {"factor", "scale"},
    {"faktor", "scale"},
    {"multiplier", "scale"},
    {"divisor", "scale", Reading::divisor},
    {"divider", "scale", Reading::divisor},
    {"teiler", "scale", Reading::divisor},
    {"gain", "scale", Reading::factor_or_divisor},
    {"scale", "scale", Reading::factor_or_divisor},
    {"scalefactor", "scale", Reading::factor_or_divisor},
    {"scaling", "scale", Reading::factor_or_divisor},
    {"scalingfactor", "scale", Reading::factor_or_divisor},
    {"sf", "scale", Reading::factor_or_divisor},
    {"skalierung", "scale", Reading::factor_or_divisor},
    {"skalierungsfaktor", "scale", Reading::factor_or_divisor},
    {"exponent", "scale", Reading::exponent},
    {"byteorder", "order"},
    {"slave", "unit"},
    {"slaveid", "unit"},
    {"unitid", "unit"},
    {"minimum", "min"},
    {"maximum", "max"},
    {"range", "range", Reading::range},
    {"valuerange", "range", Reading::range},
    {"wertebereich", "range", Reading::range},
    {"quantity", "registers", Reading::registers},
    {"registercount", "registers", Reading::registers},
    {"numberofregisters", "registers", Reading::registers},
    {"noofregisters", "registers", Reading::registers},
    {"count", "count", Reading::values_or_registers},
    {"anzahl", "count", Reading::values_or_registers},
    {"length", "length", Reading::bytes_or_registers},
    {"len", "length", Reading::bytes_or_registers},
    {"addressoffset", "address_offset", Reading::address_offset},
    {"scaleoffset", "scale_offset", Reading::scale_offset},
    {"rawoffset", "scale_offset", Reading::raw_offset},
    {"rawlow", "raw_low", Reading::raw_low},
    {"rawhigh", "raw_high", Reading::raw_high},
    {"scaledlow", "scaled_low", Reading::scaled_low},
    {"scaledhigh", "scaled_high", Reading::scaled_high},
    {"rawmin", "raw_low", Reading::raw_low},
    {"rawmax", "raw_high", Reading::raw_high},
    {"scaledmin", "scaled_low", Reading::scaled_low},
    {"scaledmax", "scaled_high", Reading::scaled_high},
    {"negatevalue", "negate", Reading::negate},
    {"scanrate", "scan_rate", Reading::left_out},
    {"clamplow", "clamp_low", Reading::left_out},
    {"clamphigh", "clamp_high", Reading::left_out},
    {"respectdatatype", "respect_data_type", Reading::left_out},
    {"scaleddatatype", "scaled_data_type", Reading::left_out},
};

}  // namespace

Meaning meaning_of(std::string_view heading) {
  // The map's own keys, as `coupler export` writes them. Other programs' "Scale" may divide, and their
  // "Count" be one of registers.
  const bool is_own = heading == "scale" || heading == "count" || heading == "length";
  const std::string word = is_own ? "" : letters_and_digits(heading);
  for (const auto& [said, key, reading] : headings)
    if (word == said) return {std::string(key), reading};
  std::string key = lower(heading);
  std::replace(key.begin(), key.end(), ' ', '_');
  return {std::move(key), Reading::plain};
}

std::string in_one_line(std::string_view heading) {
  std::string line;
  for (const char c : heading) {
    const bool is_blank = c == ' ' || c == '\t' || c == '\n' || c == '\r';
    if (!is_blank)
      line += c;
    else if (!line.empty() && line.back() != ' ')
      line += ' ';
  }
  return line;
}

std::string for_columns(std::string_view heading) {
  const std::string line = in_one_line(heading);
  return line.find(',') == std::string::npos ? line : '"' + line + '"';
}

std::string letters_and_digits(std::string_view text) {
  std::string word = lower(text);
  word.erase(std::remove_if(word.begin(), word.end(),
                            [](char c) { return !loader::is_letter(c) && !loader::is_digit(c); }),
             word.end());
  return word;
}

}  // namespace coupler::formats
