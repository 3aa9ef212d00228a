// SPDX-License-Identifier: Apache-2.0
#include "coupler/docs/words.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "coupler/codec/bit_string.hpp"
#include "coupler/codec/number.hpp"
#include "coupler/codec/value.hpp"
#include "coupler/map/allowed_values.hpp"

namespace coupler::docs {
namespace {

using codec::Type;

void add(std::string& list, std::string_view text) {
  if (text.empty()) return;
  if (!list.empty()) list += ", ";
  list += text;
}

/// Without the last digits of a product: 12.1, not 12.100000000000001.
std::string number(double value) { return fmt::format("{:.12g}", value); }

std::string one_value(const Point& point, const std::uint16_t* registers) {
  if (point.format.type == Type::BOOL) {
    const bool on =
        holds_bits(point.table) ? registers[0] != 0 : codec::decode_part(registers[0], point.format) != 0;
    return on ? "on" : "off";
  }
  if (point.scale.present()) return number(codec::published(registers, point.format, point.scale));
  if (const auto name = name_of_value(point, registers); !name.empty()) return std::string(name);
  return codec::text_of(codec::decode(registers, point.format), point.format.type);
}

/// In std_msgs; empty: bits, which have a message of this project.
std::string_view value_name(codec::Type type) {
  using codec::Type;
  switch (type) {
    case Type::BOOL: return "Bool";
    case Type::BYTE:
    case Type::WORD:
    case Type::DWORD:
    case Type::LWORD: return {};
    case Type::SINT: return "Int8";
    case Type::INT: return "Int16";
    case Type::DINT: return "Int32";
    case Type::LINT: return "Int64";
    case Type::USINT: return "UInt8";
    case Type::UINT: return "UInt16";
    case Type::UDINT: return "UInt32";
    case Type::ULINT: return "UInt64";
    case Type::REAL: return "Float32";
    case Type::LREAL: return "Float64";
    case Type::CHAR: return "Char";
    case Type::STRING: return "String";
  }
  return {};
}

/// The range of the type, without what is a fault.
codec::PublishedRange published_range(const Point& point) {
  const auto [least, most] = codec::published_range(point.format, {});
  const auto published = [&](double raw) { return raw * point.scale.gain + point.scale.offset; };
  const double a = published(std::max(least, point.faults.below));
  const double b = published(std::min(most, point.faults.above));
  return {std::min(a, b), std::max(a, b)};
}

}  // namespace

std::string words(Table table) {
  std::string text(to_string(table));
  std::replace(text.begin(), text.end(), '_', ' ');
  return text;
}

std::string_view words(Access access) {
  switch (access) {
    case Access::read: return "read";
    case Access::write: return "write";
    case Access::read_write: return "read, write";
  }
  return {};
}

std::string words(std::chrono::nanoseconds duration) {
  constexpr std::array<std::pair<std::int64_t, std::string_view>, 3> units{
      {{1'000'000'000, "s"}, {1'000'000, "ms"}, {1'000, "µs"}}};
  for (const auto& [size, unit] : units)
    if (duration.count() % size == 0) return fmt::format("{} {}", duration.count() / size, unit);
  return fmt::format("{} ns", duration.count());
}

std::string words(const codec::Scale& scale) {
  if (!scale.present()) return {};
  std::string text = scale.gain == 1 ? "raw" : "raw × " + number(scale.gain);
  if (scale.has_exponent()) text += fmt::format(" × 10^{}", scale.exponent_of);
  if (scale.offset > 0) text += " + " + number(scale.offset);
  if (scale.offset < 0) text += " - " + number(-scale.offset);
  return text;
}

std::string words(const Line& line) {
  if (!line.name.empty()) return std::string(line.name);
  return fmt::format("{} line {}", line.chip, line.offset);
}

std::string details(const Line& line) {
  std::string text;
  if (line.active_low) add(text, "active low");
  if (line.bias == Bias::none) add(text, "no bias");
  if (line.bias == Bias::pull_up) add(text, "pull-up");
  if (line.bias == Bias::pull_down) add(text, "pull-down");
  if (line.drive == Drive::open_drain) add(text, "open drain");
  if (line.drive == Drive::open_source) add(text, "open source");
  if (line.debounce.count() > 0) add(text, "debounce " + words(line.debounce));
  return text;
}

std::string words(Span<const RawRange> ranges) {
  std::string text;
  for (const auto& [first, last] : ranges)
    add(text, fmt::format("0x{:X}", first) + (first == last ? "" : fmt::format(" to 0x{:X}", last)));
  return text;
}

std::string words(const Faults& faults) {
  std::string text;
  if (faults.below != Faults::no_below) add(text, "below " + number(faults.below));
  if (faults.above != Faults::no_above) add(text, "above " + number(faults.above));
  return text;
}

std::string words(const EdgeOf& edge) {
  switch (edge.edge) {
    case Edge::rising: return fmt::format("rising edges of {}", edge.input);
    case Edge::falling: return fmt::format("falling edges of {}", edge.input);
    case Edge::both: return fmt::format("both edges of {}", edge.input);
  }
  return {};
}

std::string range_words(const Point& point) {
  const Type type = point.format.type;
  if (!codec::is_scalable(type))
    return point.format.bits != 0 ? fmt::format("0 … {}", codec::largest_in(point.format.bits))
                                  : std::string();
  if (!point.values.empty()) {
    std::string list;
    for (const NamedValue& named : point.values) add(list, fmt::format("{} {}", named.value, named.name));
    return list;
  }
  const auto [min, max, nonfinite] = point.bounds;
  if (point.scale.has_exponent()) return {};  // only the device knows it
  if (min != Bounds::no_min && max != Bounds::no_max) return number(min) + " … " + number(max);
  const auto [least, most] = published_range(point);
  // The channel takes no more, whatever the register could hold.
  if (point.pwm.present()) return number(std::max(0.0, least)) + " … " + number(std::min(100.0, most));
  if (is_float(type)) {
    if (min != Bounds::no_min) return "from " + number(min);
    return max == Bounds::no_max ? "" : "up to " + number(max);
  }
  if (limits_values(point)) return number(std::max(min, least)) + " … " + number(std::min(max, most));
  if (point.scale.present() || point.faults.present() || point.format.bits != 0)
    return number(least) + " … " + number(most);
  return codec::with_number(type, [](auto zero) {
    using Limits = std::numeric_limits<decltype(zero)>;
    return fmt::format("{} … {}", Limits::lowest(), Limits::max());
  });
}

std::string value_words(const Point& point, Span<const std::uint16_t> registers) {
  if (registers.empty()) return {};
  std::vector<std::string> values;
  for (std::size_t i = 0; i < registers.size(); i += codec::registers(point.format))
    values.push_back(one_value(point, registers.data() + i));
  const bool alike =
      std::all_of(values.begin(), values.end(), [&](const std::string& v) { return v == values.front(); });
  if (alike) return values.front() + (values.size() > 1 ? " each" : "");
  std::string list;
  for (const std::string& value : values) add(list, value);
  return list;
}

std::string ros_message(const Point& point) {
  const bool several = point.count > 1;
  const std::string_view name = point.scale.present() ? "Float64" : value_name(point.format.type);
  if (name.empty() || (several && name == "Bool")) return "coupler_driver/BoolArray";
  return "std_msgs/" + std::string(name) + (several ? "MultiArray" : "");
}

}  // namespace coupler::docs
