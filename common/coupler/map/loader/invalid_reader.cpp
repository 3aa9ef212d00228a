// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <limits>
#include <optional>
#include <type_traits>
#include <vector>

#include <fmt/format.h>

#include "coupler/codec/number.hpp"
#include "coupler/map/loader/point_reader.hpp"
#include "coupler/map/loader/scalar.hpp"

namespace coupler::loader {
namespace {

using codec::Type;

constexpr std::size_t longest_list = 16;
constexpr std::string_view form =
    "write it as in 'invalid: 0x8000', 'invalid: [0x7FFF, 0x8000]', or with a range "
    "'invalid: [[0xFFF0, 0xFFFF]]'";

std::string example_of(const codec::Format& format) {
  if (codec::is_float(format.type)) return "nan, -9999 or 0x7FC00000";
  if (format.bits != 0) return fmt::format("0x{:X}", codec::largest_in(format.bits));
  return codec::width(format.type) == 8 ? "0xFF" : "0x8000";
}

bool is_hexadecimal(std::string_view text) { return text.substr(0, 2) == "0x" || text.substr(0, 2) == "0X"; }

/// The raw value that a number or the bits in hexadecimal stand for. An integer may also be written as the
/// unsigned number with the same bits.
template <class T>
std::optional<std::uint64_t> raw_of(std::string_view text) {
  using Raw = typename codec::detail::Unsigned<sizeof(T)>::type;
  if (std::is_integral_v<T> || is_hexadecimal(text))
    if (const auto bits = parse_unsigned(text))
      return *bits <= std::numeric_limits<Raw>::max() ? bits : std::nullopt;
  if constexpr (std::is_floating_point_v<T>) {
    const auto number = parse_number(text);
    if (!number || std::fabs(*number) > static_cast<double>(std::numeric_limits<T>::max()))
      return std::nullopt;
    return codec::detail::bit_cast<Raw>(static_cast<T>(*number));
  } else {
    const auto number = parse_integer(text);
    if (!number || *number < std::int64_t{std::numeric_limits<T>::lowest()}) return std::nullopt;
    return static_cast<Raw>(*number);
  }
}

/// IEEE 754: the exponent has all bits, and the fraction at least one.
template <class T>
std::vector<RawRange> not_a_number() {
  using Raw = typename codec::detail::Unsigned<sizeof(T)>::type;
  const Raw infinity = codec::detail::bit_cast<Raw>(std::numeric_limits<T>::infinity());
  const Raw sign = Raw{1} << (8 * sizeof(T) - 1);
  const auto all = static_cast<Raw>(sign - 1);
  return {{infinity + Raw{1}, all}, {(infinity | sign) + Raw{1}, all | sign}};
}

class InvalidReader {
 public:
  InvalidReader(const Point& point, const Context& context) : point_(point), context_(context) {}

  void read(const Entry& entry) {
    if (entry.kind != Entry::Kind::list) return add(entry);
    if (entry.children.empty() || entry.children.size() > longest_list) {
      context_.problems.error(entry.at, fmt::format("'invalid' lists {} values", entry.children.size()),
                              fmt::format("list 1 to {}; a range counts as one", longest_list));
      return;
    }
    for (const Entry& element : entry.children) add(element);
  }

  std::vector<RawRange> ranges;

 private:
  void add(const Entry& element) {
    if (element.kind == Entry::Kind::list && element.children.size() == 2) return add_range(element);
    const bool is_text = element.kind == Entry::Kind::scalar && !element.quoted;
    if (is_text && codec::is_float(point_.format.type) && is_nan(element.text)) {
      for (const RawRange& range :
           point_.format.type == Type::REAL ? not_a_number<float>() : not_a_number<double>())
        ranges.push_back(range);
      return;
    }
    if (const auto raw = raw_value(element)) ranges.push_back({*raw, *raw});
  }

  void add_range(const Entry& pair) {
    const auto first = raw_value(pair.children[0]);
    const auto last = raw_value(pair.children[1]);
    if (!first || !last) return;
    const bool has_sign = is_negative(pair.children[0]) || is_negative(pair.children[1]);
    const bool has_bits = is_hexadecimal(pair.children[0].text) || is_hexadecimal(pair.children[1].text);
    const bool ascends = has_sign ? parse_number(pair.children[0].text) <= parse_number(pair.children[1].text)
                                  : *first <= *last;
    const auto wrong = [&](std::string_view what, std::string_view remedy) {
      context_.problems.error(pair.at,
                              fmt::format("'invalid' has the range {} to {}, {}", pair.children[0].text,
                                          pair.children[1].text, what),
                              std::string(remedy));
    };
    if (has_sign && has_bits)
      return wrong("of a number and of bits", "write two numbers, or two bit patterns");
    if (!ascends) return wrong("whose ends are in the wrong order", "write the smaller number first");
    if (*first <= *last) return ranges.push_back({*first, *last});
    if (!codec::is_float(point_.format.type))
      ranges.insert(ranges.end(), {{*first, mask_of_type()}, {0, *last}});
    else if (is_negative(pair.children[1]))
      ranges.push_back({*last, *first});  // the greater the bits of a negative float, the smaller the number
    else
      wrong("which crosses 0", "write two ranges, one for negative and one for positive numbers");
  }

  static bool is_negative(const Entry& end) { return end.text[0] == '-'; }
  static bool is_nan(std::string_view text) {
    return text == "nan" || text == "NaN" || text == ".nan" || text == ".NaN";
  }

  /// All bits of the type; a BOOL has those of its register.
  std::uint64_t mask_of_type() const {
    return bits() < 64 ? (std::uint64_t{1} << bits()) - 1 : ~std::uint64_t{0};
  }
  unsigned bits() const {
    const codec::Format& format = point_.format;
    if (format.bits != 0) return format.bits;
    return format.type == Type::BOOL ? 16 : codec::width(format.type);
  }

  std::optional<std::uint64_t> raw_value(const Entry& entry) const {
    std::optional<std::uint64_t> raw;
    if (entry.kind == Entry::Kind::scalar && !entry.quoted)
      raw = point_.format.type == Type::BOOL ? raw_of<std::uint16_t>(entry.text)
                                             : codec::with_number(point_.format.type, [&](auto zero) {
                                                 return raw_of<decltype(zero)>(entry.text);
                                               });
    if (raw && *raw > mask_of_type()) raw.reset();
    if (!raw)
      context_.problems.error(
          entry.at,
          fmt::format("'invalid' must be a raw value of the {} bits of {}, such as {}, not {}", bits(),
                      point_.format.type == Type::BOOL ? "the register" : to_string(point_.format.type),
                      example_of(point_.format), shown(entry)),
          std::string(form));
    if (raw) warn_of_narrow_bits(entry);
    return raw;
  }

  /// 0x8000 is what 16 bits have for no value. Of a type with more bits it is another number.
  void warn_of_narrow_bits(const Entry& entry) const {
    const unsigned digits = bits() / 4;
    const auto given = static_cast<unsigned>(entry.text.size() - 2);
    if (!is_hexadecimal(entry.text) || bits() <= 16 || given >= digits || given < 4) return;
    const std::string zeros(digits - given, '0');
    context_.problems.warning(entry.at,
                              fmt::format("'invalid' has {} for the {} bits of {}", entry.text, bits(),
                                          to_string(point_.format.type)),
                              fmt::format("write all {0} digits: 0x{2}{1}, or 0x{1}{2} if that is meant",
                                          digits, zeros, entry.text.substr(2)));
  }

  const Point& point_;
  const Context& context_;
};

}  // namespace

void read_invalid(const Reader& reader, Point& point, const Context& context) {
  const Entry* entry = reader.find("invalid");
  if (entry == nullptr) return;
  if (point.format.type == Type::STRING) {
    context.problems.error(entry->key_at, "'invalid' does not apply to STRING",
                           "remove it; a device without a text sends an empty one");
    return;
  }
  InvalidReader values(point, context);
  values.read(*entry);
  if (!values.ranges.empty()) point.invalid = context.map.keep(values.ranges);
}

void read_faults(const Reader& reader, Point& point, const Context& context) {
  Faults faults;
  reader.fields(faults);
  if (!faults.present()) return;
  if (!codec::is_scalable(point.format.type)) {
    for (const std::string_view key : {"fault_below", "fault_above"})
      if (reader.has(key))
        reader.refuse(key, fmt::format("'{}' does not apply to {}", key, to_string(point.format.type)),
                      "use a type that is a number: SINT to ULINT, REAL or LREAL");
    return;
  }
  const codec::PublishedRange range = codec::published_range(point.format, {});
  const std::string of = point.format.bits != 0 ? fmt::format("its {} bits", point.format.bits)
                                                : std::string(to_string(point.format.type));
  const auto check = [&](std::string_view key, double bound, bool is_in_range) {
    const bool is_whole = codec::is_float(point.format.type) || std::trunc(bound) == bound;
    if (reader.has(key) && !is_whole)
      context.problems.error(
          reader.find(key)->at,
          fmt::format("'{}' is {:.15g}, but raw values of {} are whole numbers", key, bound, of),
          "write the raw value, as the register holds it before 'scale'");
    else if (reader.has(key) && !is_in_range)
      context.problems.error(reader.find(key)->at,
                             fmt::format("'{}' is {:.15g}, but raw values of {} are {:.15g} to {:.15g}", key,
                                         bound, of, range.least, range.most),
                             "write a raw value between them, as the register holds it before 'scale'");
  };
  check("fault_below", faults.below, faults.below > range.least && faults.below <= range.most);
  check("fault_above", faults.above, faults.above >= range.least && faults.above < range.most);
  if (faults.below > faults.above)
    context.problems.error(reader.find("fault_below")->at, "'fault_below' is above 'fault_above'",
                           "swap the two, or change one");
  point.faults = faults;
}

}  // namespace coupler::loader
