// SPDX-License-Identifier: Apache-2.0
#include "coupler/tools/formats/structured_text.hpp"

#include <algorithm>
#include <cmath>
#include <variant>

#include <fmt/format.h>

#include "coupler/codec/bit_string.hpp"
#include "coupler/codec/value.hpp"
#include "coupler/map/loader/scalar.hpp"
#include "coupler/map/printable.hpp"

namespace coupler::formats::structured_text {
namespace {

using codec::Type;

/// Keywords of IEC 61131-3 (2013) and of Instruction List, types, standard functions and function blocks, and
/// what CODESYS and TwinCAT reserve beside them.
constexpr std::string_view reserved_words =
    " abs abstract acos action add adr and any array asin at atan atan2 begin bit bitadr bool by byte "
    "cal case char class concat configuration constant continue cos ctd ctu ctud date date_and_time "
    "delete dint div do dt dword else elsif en end_action end_case end_class end_configuration "
    "end_for end_function end_function_block end_if end_interface end_method end_namespace "
    "end_program end_property end_repeat end_resource end_step end_struct end_transition end_type "
    "end_union end_var end_while eno eq exit exp expt extends f_edge f_trig false final find for from "
    "function function_block ge gt if implements ini initial_step insert int interface internal "
    "interval jmp jmpc jmpcn ld ldate ldn ldt le left len limit lint ln log lreal lt ltime ltod lword "
    "max method mid min mod move mul mux namespace ndiv ne neg non_retain not null of on or orn "
    "overlap override persistent pointer priority private program property protected public r r_edge "
    "r_trig read_only read_write real ref ref_to reference repeat replace resource ret retain retc "
    "retcn return right rol ror rs s sel shl shr sin single sint sizeof sqrt sr st step stn string "
    "struct sub super tan task then this time time_of_day to tod tof ton tp transition true trunc "
    "type udint uint ulint union until using usint var var_access var_config var_external var_global "
    "var_in_out var_input var_inst var_output var_stat var_temp wchar while with word wstring xor "
    "xorn ";

std::string upper_exponent(std::string text) {
  std::replace(text.begin(), text.end(), 'e', 'E');
  return text;
}

struct Text {
  Type type;

  std::string operator()(bool value) const { return value ? "TRUE" : "FALSE"; }
  std::string operator()(std::int64_t value) const { return fmt::to_string(value); }
  std::string operator()(std::uint64_t value) const {
    return is_declared_as_bits(type) ? fmt::format("16#{:X}", value) : fmt::to_string(value);
  }
  std::string operator()(float value) const { return upper_exponent(codec::decimal(value)); }
  std::string operator()(double value) const { return upper_exponent(codec::decimal(value)); }
  /// A text is an array of bytes.
  std::string operator()(const std::string&) const { return {}; }
};

std::string factor(double gain) { return gain < 0 ? fmt::format("({})", Text{}(gain)) : Text{}(gain); }

/// The characters of a text, from the first in the registers on.
std::string bytes_of(const Point& point) {
  std::string list;
  const unsigned first_shift = codec::bytes_swapped(point.format.order) ? 0 : 8;
  for (unsigned i = 0; i < point.format.length; ++i) {
    const unsigned shift = i % 2 == 0 ? first_shift : 8 - first_shift;
    list += fmt::format("{}16#{:02X}", i == 0 ? "" : ", ", point.initial[i / 2] >> shift & 0xFFU);
  }
  return list;
}

}  // namespace

bool is_reserved(std::string_view name) {
  return reserved_words.find(fmt::format(" {} ", lower(name))) != std::string_view::npos;
}

std::string identifier(std::string_view name) {
  std::string out;
  for (const char c : name) {
    const bool stays = loader::is_letter(c) || loader::is_digit(c);
    if (stays || out.empty() || out.back() != '_') out += stays ? c : '_';
  }
  while (!out.empty() && out.back() == '_') out.pop_back();
  return out;
}

std::string comment(std::string_view text) {
  std::string out = "(* ";
  // Comments may be nested, and some compilers know /* */ as well.
  for (const char c : printable(text)) {
    const char last = out.back();
    if ((c == '*' && (last == '(' || last == '/')) || (last == '*' && (c == ')' || c == '/'))) out += ' ';
    out += c;
  }
  return out + " *)";
}

std::string declared_type(const Point& point) {
  const Type type = point.format.type;
  if (type == Type::STRING) return fmt::format("ARRAY [0..{}] OF BYTE", point.format.length);
  const std::string_view element = point.scale.present() ? "LREAL"
                                   : type == Type::CHAR  ? "BYTE"
                                                         : to_string(type);
  return point.count == 1 ? std::string(element)
                          : fmt::format("ARRAY [0..{}] OF {}", point.count - 1, element);
}

bool is_declared_as_bits(Type type) { return codec::is_bit_string(type) || type == Type::CHAR; }

std::string_view bits_of(Type type) {
  switch (codec::width(type)) {
    case 8: return "BYTE";
    case 16: return "WORD";
    case 32: return "DWORD";
    default: return "LWORD";
  }
}

std::string number(const Point& point, const std::uint16_t* registers) {
  if (point.scale.present()) return Text{}(codec::published(registers, point.format, point.scale));
  return std::visit(Text{point.format.type}, codec::decode(registers, point.format));
}

std::string lreal(double value) { return Text{}(value); }

std::string scaled(const std::string& raw, const codec::Scale& scale) {
  std::string text = raw;
  if (scale.gain != 1) text += " * " + factor(scale.gain);
  if (scale.offset != 0)
    text += fmt::format(" {} {}", scale.offset < 0 ? '-' : '+', Text{}(std::abs(scale.offset)));
  return text;
}

std::string unscaled(const std::string& value, const codec::Scale& scale) {
  std::string text = value;
  if (scale.offset != 0)
    text = fmt::format("({} {} {})", value, scale.offset < 0 ? '+' : '-', Text{}(std::abs(scale.offset)));
  if (scale.gain != 1) text += " / " + factor(scale.gain);
  return text;
}

std::string initial_value(const Point& point) {
  const auto is_zero = [](std::uint16_t word) { return word == 0; };
  if (point.initial.empty() && may_be_zero(point)) return {};
  const std::vector<std::uint16_t> start = start_registers(point);
  const bool scaled = point.scale.present();  // its 0 may be the offset
  if (!scaled && std::all_of(start.begin(), start.end(), is_zero)) return {};
  if (point.format.type == Type::STRING) return "[" + bytes_of(point) + "]";
  std::string list;
  for (std::size_t i = 0; i < point.count; ++i) {
    list += (i == 0 ? "" : ", ") + number(point, start.data() + i * codec::registers(point.format));
  }
  return point.count == 1 ? list : "[" + list + "]";
}

}  // namespace coupler::formats::structured_text
