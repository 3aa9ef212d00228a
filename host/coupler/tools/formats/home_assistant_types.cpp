// SPDX-License-Identifier: Apache-2.0
// `data_type`, `structure`, `count` and `swap` of a sensor. The rules are those of struct_validator() in
// homeassistant/components/modbus/validators.py and of Python's module struct.
#include <algorithm>

#include <fmt/format.h>

#include "coupler/map/loader/scalar.hpp"
#include "coupler/modbus/limits.hpp"
#include "coupler/tools/formats/home_assistant_points.hpp"
#include "coupler/tools/formats/map_tree.hpp"

namespace coupler::formats {
namespace {

using loader::Entry;
using loader::shown;

/// A type by its name in `data_type` and its letter in `structure`.
struct TypeOf {
  std::string_view data_type;
  char letter;
  unsigned bytes;
  std::string_view iec;  ///< empty: the map has none
};
constexpr TypeOf types[] = {
    {"int16", 'h', 2, "INT"},    {"uint16", 'H', 2, "UINT"},
    {"int32", 'i', 4, "DINT"},   {"uint32", 'I', 4, "UDINT"},
    {"int64", 'q', 8, "LINT"},   {"uint64", 'Q', 8, "ULINT"},
    {"float32", 'f', 4, "REAL"}, {"float64", 'd', 8, "LREAL"},
    {"", 'l', 4, "DINT"},        {"", 'L', 4, "UDINT"},
    {"", 'b', 1, "SINT"},        {"", 'B', 1, "USINT"},
    {"float16", 'e', 2, ""},     {"", '?', 1, ""},
    {"", 'c', 1, "CHAR"},
};

/// The change of order that registers need before they are a value.
struct Swap {
  bool words = false;  ///< the registers are reversed
  bool bytes = false;  ///< the two bytes of each are

  bool any() const { return words || bytes; }
};

std::string_view order_of(Swap swap, unsigned bytes) {
  if (bytes == 2) return swap.bytes ? "BA" : "AB";
  if (swap.words) return swap.bytes ? "DCBA" : "CDAB";
  return swap.bytes ? "BADC" : "ABCD";
}

/// `swap`, or `reverse_order` of old versions. nullopt, with an error, if it is none.
std::optional<Swap> read_swap(Settings& settings) {
  const std::string swap = settings.text("swap", "none");
  if (swap != "none" && swap != "byte" && swap != "word" && swap != "word_byte") {
    settings.problems().error(settings.find("swap")->at, fmt::format("{} is not a swap", shown(swap)),
                              "write none, byte, word or word_byte");
    return std::nullopt;
  }
  const bool reversed = settings.flag("reverse_order");
  if (reversed && swap != "none" && swap != "word") {
    settings.problems().error(settings.find("reverse_order")->at,
                              fmt::format("'reverse_order' means 'swap: word', but 'swap' is {}", swap),
                              "remove one of the two");
    return std::nullopt;
  }
  return Swap{reversed || swap == "word" || swap == "word_byte", swap == "byte" || swap == "word_byte"};
}

RegisterValue text_of(unsigned registers, unsigned bytes, bool swapped, loader::Position at) {
  RegisterValue value;
  value.registers = registers;
  value.is_number = false;
  value.keys = {scalar("type", "STRING", at), scalar("length", fmt::to_string(bytes), at)};
  // On a map's default the first character is in the low byte, which is Home Assistant's `swap: byte`.
  if (!swapped) value.keys.push_back(scalar("order", "AB", at));
  return value;
}

RegisterValue number_of(const TypeOf& type, unsigned count, Swap swap, loader::Position at) {
  RegisterValue value;
  value.registers = count * type.bytes / 2;
  value.keys = {scalar("type", std::string(type.iec), at)};
  const std::string_view order = order_of(swap, type.bytes);
  if (order != "AB") value.keys.push_back(scalar("order", std::string(order), at));
  if (count > 1) value.keys.push_back(scalar("count", fmt::to_string(count), at));
  return value;
}

/// Reads a `structure` such as ">xB" or ">hHf".
class StructureReader {
 public:
  StructureReader(const Entry& given, Swap swap, loader::Problems& problems)
      : given_(given), swap_(swap), problems_(problems) {}

  std::vector<RegisterValue> read(unsigned registers) {
    std::string_view text = given_.text;
    const char first = text.empty() ? '@' : text[0];
    if (first != '>' && first != '!' && first != '<') {
      refuse("its byte order is that of the computer",
             "begin it with '>' if the most significant byte comes first");
      return {};
    }
    little_ = first == '<';
    for (text.remove_prefix(1); good_ && !text.empty();) read_item(text);
    if (good_ && at_ != 2 * registers)
      refuse(fmt::format("it has {} bytes, but 'count' is {} registers", at_, registers),
             "correct one of the two");
    if (!good_) return {};
    if (values_.size() > 1)
      for (std::size_t i = 0; i < values_.size(); ++i) values_[i].suffix = fmt::format("_{}", i);
    if (values_.empty()) refuse("it holds no value", "name the types of the values");
    // The registers are swapped as a whole, so of several values each would be at another place.
    if (swap_.any() && !is_one_number(registers)) {
      refuse("'swap' changes the registers of more than one number",
             "make each value an entity of its own, with 'data_type' and 'swap'");
      return {};
    }
    return std::move(values_);
  }

 private:
  bool is_one_number(unsigned registers) const {
    return numbers_ == 1 && values_.size() == 1 && values_[0].registers == registers;
  }

  void refuse(const std::string& why, const std::string& remedy) {
    problems_.warning(given_.at, fmt::format("the structure {} is left out: {}", shown(given_.text), why),
                      remedy);
    good_ = false;
  }

  void read_item(std::string_view& text) {
    if (text[0] == ' ') return text.remove_prefix(1);
    unsigned count = 0;
    const bool counted = loader::is_digit(text[0]);
    while (!text.empty() && loader::is_digit(text[0]) && count < modbus::max_read_registers * 2U) {
      count = count * 10 + static_cast<unsigned>(text[0] - '0');
      text.remove_prefix(1);
    }
    if (!counted) count = 1;
    if (text.empty() || count > modbus::max_read_registers * 2U)
      return refuse("it is not one of Python's module struct", "write it as in '>hHf'");
    const char letter = text[0];
    text.remove_prefix(1);
    if (letter == 'x') {
      at_ += count;
    } else if (letter == 's') {
      add(text_of((count + 1) / 2, count, false, given_.at), count);
    } else {
      const auto* type = std::find_if(std::begin(types), std::end(types),
                                      [letter](const TypeOf& each) { return each.letter == letter; });
      if (type == std::end(types) || type->iec.empty())
        return refuse(fmt::format("the map has no type for '{}'", letter), "read the registers as UINT");
      if (type->bytes == 1) {
        for (unsigned i = 0; i < count; ++i) add_byte(*type);
      } else if (count > 0) {
        numbers_ += count;
        add(number_of(*type, count, {little_ != swap_.words, little_ != swap_.bytes}, given_.at),
            count * type->bytes);
      }
    }
  }

  void add(RegisterValue value, unsigned bytes) {
    if (at_ % 2 != 0)
      return refuse("a value begins in the middle of a register", "read the registers as UINT");
    value.register_offset = at_ / 2;
    at_ += bytes;
    values_.push_back(std::move(value));
  }

  void add_byte(const TypeOf& type) {
    RegisterValue value;
    value.register_offset = at_ / 2;
    const bool high = at_++ % 2 == 0;
    value.mask = high ? 0xFF00 : 0x00FF;
    value.keys = {scalar("type", std::string(type.iec), given_.at),
                  scalar("offset", high ? "high" : "low", given_.at)};
    value.is_number = type.iec != "CHAR";
    values_.push_back(std::move(value));
  }

  const Entry& given_;
  Swap swap_;
  loader::Problems& problems_;
  bool little_ = false;
  bool good_ = true;
  unsigned at_ = 0;  ///< bytes
  unsigned numbers_ = 0;
  std::vector<RegisterValue> values_;
};

/// `int`, `uint` and `float` of old versions have their width from `count`.
std::optional<std::string> modern_name(const std::string& type, unsigned count, Settings& settings) {
  if (type != "int" && type != "uint" && type != "float") return type;
  if (count == 1 || count == 2 || count == 4) return type + fmt::to_string(16 * count);
  settings.problems().error(settings.find("count")->at,
                            fmt::format("'count' is {}, but '{}' has 1, 2 or 4 registers", count, type),
                            fmt::format("correct it, or write {0}16, {0}32 or {0}64 without 'count'", type));
  return std::nullopt;
}

/// nullptr, with the reason in the problems, if it is none or the map has none for it.
const TypeOf* numeric_type(const std::string& given, std::optional<unsigned> count, Settings& settings) {
  const auto name = modern_name(given, count.value_or(1), settings);
  if (!name) return nullptr;
  const auto* known = std::find_if(std::begin(types), std::end(types), [&](const TypeOf& each) {
    return each.data_type == *name && !name->empty();
  });
  loader::Problems& problems = settings.problems();
  const Entry* written = settings.find("data_type");
  const loader::Position at = written != nullptr ? written->at : settings.at();
  if (known == std::end(types)) {
    problems.error(at, fmt::format("{} is not a data type", shown(given)),
                   "write int16 to int64, uint16 to uint64, float32, float64, string or custom");
    return nullptr;
  }
  if (count && *count != known->bytes / 2) {
    problems.error(settings.find("count")->at,
                   fmt::format("'count' is {}, but {} has {} register{}", *count, *name, known->bytes / 2,
                               known->bytes == 2 ? "" : "s"),
                   "remove 'count', or correct 'data_type'");
    return nullptr;
  }
  if (known->iec.empty()) {
    problems.warning(at, fmt::format("the map has no type for {}, so the entity is left out", shown(*name)),
                     "read the register as WORD, or write float32 if there are two");
    return nullptr;
  }
  return known;
}

}  // namespace

unsigned elements_of(Settings& settings, unsigned most) {
  const auto values = settings.whole("virtual_count", most);
  const auto slaves = settings.whole("slave_count", most);
  if (values && slaves && *values != *slaves)
    settings.problems().error(settings.find("slave_count")->at,
                              "'slave_count' and 'virtual_count' mean the same, but differ",
                              "remove one of the two");
  return 1 + values.value_or(slaves.value_or(0));
}

std::vector<RegisterValue> read_data_type(Settings& settings) {
  const std::string type = settings.text("data_type", "int16");
  const auto count = settings.whole("count", modbus::max_read_registers);
  const Entry* structure = settings.find("structure");
  const unsigned elements = elements_of(settings, modbus::max_read_registers);
  const auto swap = read_swap(settings);
  if (!swap) return {};
  if (elements > 1 && (type == "custom" || type == "string")) {
    const Entry* given = settings.find("virtual_count");
    if (given == nullptr) given = settings.find("slave_count");
    settings.problems().warning(
        given->at,
        fmt::format("'{}' is left out: Home Assistant repeats numbers, not 'data_type: {}'", given->key,
                    type),
        "write an entity for each of the values");
  }
  if (type == "custom") {
    if (structure != nullptr)
      return StructureReader(*structure, *swap, settings.problems()).read(count.value_or(1));
    settings.problems().error(settings.at(), "'data_type: custom' has no 'structure'",
                              "write one, such as '>h'");
    return {};
  }
  if (type == "string") {
    const unsigned registers = count.value_or(1);
    if (swap->words && registers > 1) {
      settings.problems().warning(settings.at(), "a text whose registers are reversed is left out",
                                  "read the registers as UINT");
      return {};
    }
    return {text_of(registers, 2 * registers, swap->bytes, settings.at())};
  }
  const TypeOf* known = numeric_type(type, count, settings);
  if (known == nullptr) return {};
  return {number_of(*known, elements, *swap, settings.at())};
}

}  // namespace coupler::formats
