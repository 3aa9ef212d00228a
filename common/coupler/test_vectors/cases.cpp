// SPDX-License-Identifier: Apache-2.0
#include "coupler/test_vectors/cases.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <type_traits>

#include "coupler/codec/number.hpp"
#include "coupler/codec/text.hpp"
#include "coupler/map/allowed_values.hpp"

namespace coupler::test_vectors {
namespace {

using codec::Encoding;

/// One value of a point as codec::registers(point.format) registers.
using Element = std::vector<std::uint16_t>;

/// All bytes differ, and no byte stays where it is when the bytes are reversed.
template <class T>
constexpr auto pattern() {
  using U = typename codec::detail::Unsigned<sizeof(T)>::type;
  if constexpr (sizeof(T) == 1)
    return U{0x5A};
  else
    return static_cast<U>(0x0123456789ABCDEFU >> (64 - 8 * sizeof(T)));
}

/// Zero, one, negative values, the ends of the type, and patterns that show where each byte stands.
template <class T>
std::vector<T> samples() {
  using Ends = std::numeric_limits<T>;
  const auto shown = codec::detail::bit_cast<T>(pattern<T>());
  const auto inverse = codec::detail::bit_cast<T>(static_cast<decltype(pattern<T>())>(~pattern<T>()));
  if constexpr (std::is_floating_point_v<T>)
    return {T{0},
            T{1},
            T{-1.5},
            shown,
            inverse,
            Ends::lowest(),
            Ends::max(),
            Ends::min(),
            Ends::denorm_min(),
            -Ends::denorm_min(),
            -T{0},
            Ends::infinity(),
            -Ends::infinity(),
            Ends::quiet_NaN()};
  else if constexpr (std::is_signed_v<T>)
    return {T{0}, T{1}, T{-1}, shown, inverse, Ends::min(), Ends::max()};
  else
    return {T{0}, T{1}, shown, inverse, Ends::max()};
}

/// Values next to the ends of the type that it cannot hold.
template <class T>
std::vector<codec::Value> outside() {
  using Ends = std::numeric_limits<T>;
  if constexpr (std::is_same_v<T, double>)
    return {};
  else if constexpr (std::is_same_v<T, float>)
    return {1e39, -1e39};
  else if constexpr (std::is_same_v<T, std::uint64_t>)
    return {std::int64_t{-1}};
  else if constexpr (std::is_same_v<T, std::int64_t>)
    return {static_cast<std::uint64_t>(Ends::max()) + 1};
  else
    return {std::int64_t{Ends::min()} - 1, std::int64_t{Ends::max()} + 1};
}

std::vector<Element> number_elements(const codec::Format& format) {
  if (format.type == codec::Type::BOOL) return {{0}, {codec::mask(format)}};
  return codec::with_number(format.type, [&](auto zero) {
    std::vector<Element> elements;
    using T = decltype(zero);
    for (T value : samples<T>()) {
      if constexpr (codec::may_be_partial<T>)
        if (format.bits != 0) value = static_cast<T>(value & codec::largest_in(format.bits));
      elements.emplace_back(codec::registers(format));
      codec::put(value, format, elements.back().data());
    }
    return elements;
  });
}

std::vector<codec::Value> refused_numbers(const codec::Format& format) {
  const codec::Type type = format.type;
  if (type == codec::Type::BOOL) return {};
  if (format.bits != 0) return {std::int64_t{-1}, std::int64_t{codec::largest_in(format.bits)} + 1};
  return codec::with_number(type, [](auto zero) { return outside<decltype(zero)>(); });
}

/// Numbers beyond the ends of a scale.
std::vector<codec::Value> refused_scaled(const codec::Format& format, const codec::Scale& scale) {
  using Double = std::numeric_limits<double>;
  std::vector<codec::Value> values{Double::quiet_NaN(), Double::infinity(), -Double::infinity()};
  const auto [least, most] = codec::published_range(format, scale);
  const double width = most - least;
  if (most + width <= Double::max() && least - width >= Double::lowest()) {
    values.emplace_back(most + width);
    values.emplace_back(least - width);
  }
  return values;
}

std::string alphabet(std::size_t length) {
  std::string text;
  for (std::size_t i = 0; i < length; ++i) text += static_cast<char>('A' + i % 26);
  return text;
}

std::string repeated(std::string_view character, std::size_t count) {
  std::string text;
  while (count-- > 0) text += character;
  return text;
}

/// Some do not fit.
std::vector<std::string> texts(const codec::Format& format) {
  const std::size_t length = format.length;
  std::vector<std::string> some{"", "A", "Ab1", alphabet(length - 1), alphabet(length)};
  switch (format.encoding) {
    case Encoding::utf8:
      some.insert(some.end(), {"é", "Größe 7 µm", "€ 𝄞", repeated("ü", length / 2) + alphabet(length % 2)});
      break;
    case Encoding::latin1: some.insert(some.end(), {"é", "Größe 7 µm", repeated("ÿ", length)}); break;
    case Encoding::ascii: some.push_back(repeated("~", length)); break;
  }
  return some;
}

std::vector<Element> text_elements(const codec::Format& format) {
  std::vector<Element> elements;
  const auto add = [&](std::string_view text, const codec::Format& as) {
    Element element(codec::registers(format));
    if (codec::encode_text(text, as, element.data()) == codec::TextError::none) elements.push_back(element);
  };
  for (const std::string& text : texts(format)) add(text, format);
  codec::Format bytes = format;  // Latin-1 has all of them, each as itself
  bytes.encoding = Encoding::latin1;
  add("a\x01z", bytes);  // and NUL in place of the 1, behind which nothing counts
  for (std::uint16_t& word : elements.back())
    word = static_cast<std::uint16_t>((word >> 8 == 1 ? 0 : word & 0xFF00) |
                                      ((word & 0xFF) == 1 ? 0 : word & 0xFF));
  if (format.encoding == Encoding::ascii) add("é", bytes);
  return elements;
}

/// Texts that are too long, or have a character that the encoding does not have.
std::vector<codec::Value> refused_texts(const codec::Format& format) {
  std::vector<codec::Value> refused{alphabet(format.length + 1U)};
  switch (format.encoding) {
    case Encoding::utf8: refused.emplace_back(alphabet(format.length - 1U) + "é"); break;
    case Encoding::latin1: refused.emplace_back("€"); break;
    case Encoding::ascii: refused.emplace_back("é"); break;
  }
  return refused;
}

std::vector<Element> elements_of(const Point& point) {
  if (holds_bits(point.table)) return {{0}, {1}};
  return point.format.type == codec::Type::STRING ? text_elements(point.format)
                                                  : number_elements(point.format);
}

/// nullopt: no integer of 64 bits has it.
std::optional<codec::Value> integer_of(double number) {
  constexpr double two_to_63 = 9223372036854775808.0;
  if (number >= -two_to_63 && number < two_to_63) return static_cast<std::int64_t>(number);
  if (number >= two_to_63 && number < 2 * two_to_63) return static_cast<std::uint64_t>(number);
  return std::nullopt;
}

/// Published as integers: neither a float nor scaled.
bool is_integer(const Point& point) { return !point.scale.present() && !codec::is_float(point.format.type); }

/// A number as the point publishes it; nullopt: none that it could publish.
std::optional<codec::Value> number_of(const Point& point, double number) {
  if (is_integer(point)) return integer_of(number);
  if (!point.scale.present() && point.format.type == codec::Type::REAL) return static_cast<float>(number);
  return number;
}

/// `min` and `max`, and beside each a number that must not be written: the next one, and for integers above
/// 2^53 the next double, since bounds are doubles.
void add_bounds(const Point& point, std::vector<Element>& allowed, std::vector<codec::Value>& refused) {
  const double step = std::fabs(point.scale.gain);
  const auto add = [&](double bound, double direction) {
    Element element(codec::registers(point.format));
    const auto value = number_of(point, bound);
    if (value && encode(*value, point, element.data())) allowed.push_back(element);
    double beyond = bound + direction * step;
    if (is_integer(point) && beyond == bound)
      beyond = std::nextafter(bound, direction * std::numeric_limits<double>::infinity());
    if (const auto next = number_of(point, beyond)) refused.push_back(*next);
  };
  if (point.bounds.min != Bounds::no_min) add(point.bounds.min, -1);
  if (point.bounds.max != Bounds::no_max) add(point.bounds.max, 1);
}

/// The named values, and a number between or behind them that has no name.
void add_names(const Point& point, std::vector<Element>& allowed, std::vector<codec::Value>& refused) {
  if (point.values.empty()) return;
  constexpr std::int64_t most = std::numeric_limits<std::int64_t>::max();
  std::int64_t last = point.values.front().value;  // of those without a gap
  for (const NamedValue& named : point.values) {
    allowed.emplace_back(codec::registers(point.format));
    (void)codec::encode(named.value, point.format, allowed.back().data());
    if (last != most && named.value == last + 1) last = named.value;
  }
  if (last != most)
    refused.emplace_back(last + 1);
  else
    refused.emplace_back(static_cast<std::uint64_t>(most) + 1);
}

/// `pick(i)`: which element is the i-th value.
template <class Pick>
Case make_case(const Point& point, const std::vector<Element>& elements, Pick pick) {
  Case made;
  for (std::size_t i = 0; i < point.count; ++i) {
    const Element& element = elements[pick(i) % elements.size()];
    made.raw.insert(made.raw.end(), element.begin(), element.end());
    made.values.push_back(decode(point, element.data()));
  }
  std::vector<std::uint16_t> written(made.raw.size());
  const std::size_t width = codec::registers(point.format);
  for (std::size_t i = 0; i < point.count; ++i)
    made.only_read |= !encode(made.values[i], point, &written[i * width]);
  made.only_read |= written != made.raw || find_forbidden(point, made.raw.data());
  return made;
}

std::vector<codec::Value> refused_by(const Point& point, std::vector<codec::Value> beyond) {
  std::vector<codec::Value> values;
  if (holds_bits(point.table) || !is_writable(point)) return values;
  if (point.format.type == codec::Type::STRING)
    values = refused_texts(point.format);
  else if (point.scale.present())
    values = refused_scaled(point.format, point.scale);
  else
    values = refused_numbers(point.format);
  values.insert(values.end(), beyond.begin(), beyond.end());
  // A scale of a wide type rounds its own ends: what it still takes is no example.
  std::vector<std::uint16_t> registers(codec::registers(point.format));
  const auto taken = [&](const codec::Value& value) {
    return encode(value, point, registers.data()) && !why_forbidden(point, registers.data());
  };
  values.erase(std::remove_if(values.begin(), values.end(), taken), values.end());
  return values;
}

}  // namespace

codec::Value decode(const Point& point, const std::uint16_t* registers) {
  if (holds_bits(point.table)) return registers[0] != 0;
  if (point.scale.present()) return codec::published(registers, point.format, point.scale);
  return codec::decode(registers, point.format);
}

bool encode(const codec::Value& value, const Point& point, std::uint16_t* registers) {
  if (holds_bits(point.table)) {
    const bool* on = std::get_if<bool>(&value);
    if (on != nullptr) registers[0] = *on ? 1 : 0;
    return on != nullptr;
  }
  if (!point.scale.present()) return codec::encode(value, point.format, registers).has_value();
  const double* number = std::get_if<double>(&value);
  return number != nullptr &&
         codec::encode_published(*number, point.format, point.scale, registers) == codec::ScaleError::none;
}

Cases cases_of(const Point& point) {
  std::vector<Element> elements = elements_of(point);
  std::vector<codec::Value> beyond;
  add_bounds(point, elements, beyond);
  add_names(point, elements, beyond);
  std::vector<Case> cases;
  const auto add = [&](Case&& made) {
    const auto same = [&](const Case& other) { return other.raw == made.raw; };
    if (is_invalid(point, made.raw.data())) return;
    if (std::none_of(cases.begin(), cases.end(), same)) cases.push_back(std::move(made));
  };
  if (point.count > 1 && point.format.type == codec::Type::BOOL)
    for (const std::size_t all : {0U, 1U}) add(make_case(point, elements, [&](std::size_t) { return all; }));
  for (std::size_t first = 0; first < elements.size(); ++first)
    add(make_case(point, elements, [&](std::size_t i) { return first + i; }));
  return {std::move(cases), refused_by(point, beyond)};
}

}  // namespace coupler::test_vectors
