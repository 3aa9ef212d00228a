// SPDX-License-Identifier: Apache-2.0
// `type:`, which people write as they know it from other languages and from registers' lists.
#include <algorithm>

#include <fmt/format.h>

#include "coupler/codec/type_name.hpp"
#include "coupler/map/loader/point_reader.hpp"
#include "coupler/map/loader/scalar.hpp"
#include "coupler/map/nearest.hpp"

namespace coupler::loader {
namespace {

using codec::Type;

std::string with_width(Type type) {
  return codec::width(type) == 0 ? std::string(to_string(type))
                                 : fmt::format("{} ({} bits)", to_string(type), codec::width(type));
}

/// The first number in the text, and where it begins.
struct Number {
  std::size_t at = std::string_view::npos;
  std::size_t end = 0;
  unsigned value = 0;
};
Number number_in(std::string_view text) {
  Number number;
  number.at = text.find_first_of("0123456789");
  if (number.at == std::string_view::npos) return number;
  number.end = std::min(text.find_first_not_of("0123456789", number.at), text.size());
  number.value =
      static_cast<unsigned>(parse_unsigned(text.substr(number.at, number.end - number.at)).value_or(0));
  return number;
}

/// "STRING[12]", "text 12", "INT[4]": a type that exists, and a number that has a key of its own.
std::string remedy_for_size(std::string_view text) {
  const Number number = number_in(text);
  if (number.at == std::string_view::npos || number.at == 0 || number.value == 0) return {};
  const bool bracket = text[number.at - 1] == '[' || text[number.at - 1] == '(';
  const auto type = codec::parse_type(text.substr(0, number.at - (bracket ? 1 : 0)));
  const std::string_view rest = text.substr(number.end);
  const bool closed = bracket ? rest == "]" || rest == ")" : rest.empty();
  if (!type || !closed) return {};
  if (*type == Type::STRING || (*type == Type::CHAR && bracket))
    return fmt::format("write 'type: STRING, length: {}'", number.value);
  return bracket ? fmt::format("write 'type: {}, count: {}'", to_string(*type), number.value) : std::string();
}

/// "FLOAT32_BE", "uint32-cdab": the type, and an order that has a key of its own.
std::string remedy_for_order(std::string_view text) {
  const std::string folded = codec::folded_type_name(text);
  for (const std::string_view order :
       {"abcd", "cdab", "badc", "dcba", "byteswap", "swapped", "swap", "sw", "be", "le", "b", "l"}) {
    if (folded.size() <= order.size() || folded.substr(folded.size() - order.size()) != order) continue;
    const auto type = codec::parse_type(folded.substr(0, folded.size() - order.size()));
    if (!type || codec::width(*type) < 16) continue;
    const bool several = codec::width(*type) > 16;
    if (const auto known = words(find_key("order", Section::input_register)->choices); several)
      for (const std::string_view exact : known)
        if (lower(exact) == order) return fmt::format("write 'type: {}, order: {}'", to_string(*type), exact);
    return fmt::format("write 'type: {}', and the order of its bytes as 'order', one of {}", to_string(*type),
                       several ? "ABCD, CDAB, BADC and DCBA" : "AB and BA");
  }
  return {};
}

/// Returns the remedy for types of manuals for which IEC 61131-3 has no type that a register could hold.
std::string remedy_for_what_is_no_type(std::string_view text) {
  const std::string word = codec::folded_type_name(text);
  const auto is_one_of = [&](std::initializer_list<std::string_view> words) {
    return std::find(words.begin(), words.end(), word) != words.end();
  };
  if (is_one_of({"bcd", "bcd16", "bcd32", "lbcd"}))
    return "there is no BCD; write WORD (4 digits) or DWORD (8 digits), and convert the digits in your "
           "program";
  if (is_one_of({"half", "float16", "f16", "fp16", "real16"}))
    return "there is no floating-point type of 16 bits; write WORD, and convert it in your program";
  if (is_one_of({"ascii", "utf8", "latin1"}))
    return fmt::format("write 'type: STRING' with its 'length' and 'encoding: {}'", word == "utf8" ? "utf-8"
                                                                                    : word == "latin1"
                                                                                        ? "latin-1"
                                                                                        : "ascii");
  if (is_one_of(
          {"time", "ltime", "date", "datetime", "dateandtime", "dt", "ldt", "tod", "timeofday", "timestamp"}))
    return "write the type of the number that holds the time, such as UINT, UDINT or ULINT";
  return {};
}

/// "did you mean …?", of the width that the number in the word says. Two types at the same distance are named
/// both: which of them was meant decides how many registers are read.
std::string remedy_for_near_name(std::string_view word, const Number& number) {
  std::vector<std::string_view> names;
  const auto add = [&](Type type) {
    for (const std::string_view name : codec::names_of(type)) names.push_back(name);
  };
  for (const auto& each : enumeration_of<Type>.words)
    if (number.at == std::string_view::npos || codec::width(each.value) == number.value) add(each.value);
  std::vector<Type> meant;
  for (const std::string_view name : all_nearest(word, names))
    if (const auto type = codec::parse_type(name);
        type && std::find(meant.begin(), meant.end(), *type) == meant.end())
      meant.push_back(*type);
  constexpr std::size_t most = 3;
  if (meant.empty() || meant.size() > most) return {};
  if (meant.size() == 1) return fmt::format("did you mean '{}'?", to_string(meant.front()));
  std::vector<std::string> texts;
  texts.reserve(meant.size());
  for (const Type type : meant) texts.push_back(with_width(type));
  return fmt::format("did you mean {}?", fmt::join(texts, " or "));
}

std::string remedy_for_width(const Number& number) {
  if (number.at == std::string_view::npos || number.value == 0) return {};
  std::vector<std::string_view> types;
  for (const auto& each : enumeration_of<Type>.words)
    if (codec::width(each.value) == number.value) types.push_back(each.word);
  if (!types.empty())
    return fmt::format("write one of those of {} bits: {}", number.value, fmt::join(types, ", "));
  constexpr unsigned widest = 256;
  if (number.value == 0 || number.value % 8 != 0 || number.value > widest) return {};
  return fmt::format(
      "no type has {} bits: read the registers as 'type: UINT, count: {}', and join them in your program",
      number.value, (number.value + 15) / 16);
}

std::string remedy(std::string_view word) {
  const Number number = number_in(word);
  for (std::string text : {remedy_for_size(word), remedy_for_order(word), remedy_for_what_is_no_type(word),
                           remedy_for_near_name(word, number), remedy_for_width(number)})
    if (!text.empty()) return text;
  return or_update(
      "write the one that the device's manual means ('INT' has 16 bits, 'DINT' and 'REAL' have 32)");
}

}  // namespace

void read_type(const Reader& reader, Type& type, const Context& context) {
  const Entry* entry = reader.find("type");
  if (entry == nullptr) return;
  const std::string_view word = entry->kind == Entry::Kind::scalar ? std::string_view(entry->text) : "";
  if (const auto known = codec::parse_type(word)) {
    type = *known;
  } else if (const codec::AmbiguousTypeName* name = codec::find_ambiguous_type(word)) {
    context.problems.error(entry->at,
                           fmt::format("{} has {} bits in some manuals and {} in others", shown(word),
                                       codec::width(name->one), codec::width(name->other)),
                           fmt::format("write {} or {}", with_width(name->one), with_width(name->other)));
  } else {
    context.problems.error(
        entry->at,
        fmt::format("'type' must be one of {}, not {}",
                    fmt::join(words(find_key("type", Section::input_register)->choices), ", "),
                    shown(*entry)),
        context.unless_served(remedy(word)));
  }
}

}  // namespace coupler::loader
