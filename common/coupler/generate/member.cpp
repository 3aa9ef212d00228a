// SPDX-License-Identifier: Apache-2.0
#include "coupler/generate/member.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <map>
#include <set>

#include "coupler/codec/number.hpp"
#include "coupler/codec/text.hpp"
#include "coupler/generate/code.hpp"
#include "coupler/generate/macros.hpp"
#include "coupler/map/typed_value.hpp"

namespace coupler::generate {
namespace {

using codec::Type;

// Other members of a client, and the macros that programs use most.
constexpr std::string_view taken[] = {"Client",     "EOF",        "NULL",        "Session",   "connect",
                                      "disconnect", "each_point", "map",         "on_online", "online",
                                      "options",    "use",        "wait_online", "write_all"};

/// An identifier for each name; none is one of `taken` or of small_macros().
std::vector<std::string> cpp_names(const std::vector<std::string_view>& names) {
  std::vector<std::string_view> reserved(std::begin(taken), std::end(taken));
  reserved.insert(reserved.end(), small_macros().begin(), small_macros().end());
  return identifiers(names, reserved, is_identifier);
}

std::string_view cpp_number(Type type) {
  switch (type) {
    case Type::BOOL: return "bool";
    case Type::SINT: return "::std::int8_t";
    case Type::INT: return "::std::int16_t";
    case Type::DINT: return "::std::int32_t";
    case Type::LINT: return "::std::int64_t";
    case Type::BYTE:
    case Type::CHAR:
    case Type::USINT: return "::std::uint8_t";
    case Type::WORD:
    case Type::UINT: return "::std::uint16_t";
    case Type::DWORD:
    case Type::UDINT: return "::std::uint32_t";
    case Type::LWORD:
    case Type::ULINT: return "::std::uint64_t";
    case Type::REAL: return "float";
    case Type::LREAL: return "double";
    case Type::STRING: return "::std::string";
  }
  return {};
}

std::string value_range(const Point& point) {
  const Type type = point.format.type;
  if (type == Type::STRING)
    return fmt::format(", at most {} bytes of {}", point.format.length,
                       codec::to_string(point.format.encoding));
  if (type == Type::BOOL || type == Type::CHAR || point.scale.has_exponent()) return {};
  const auto [min, max, nonfinite] = point.bounds;
  const bool bounded = min != Bounds::no_min || max != Bounds::no_max;
  if (bounded || point.scale.present() || point.format.bits != 0) {
    const auto [least, most] = codec::published_range(point.format, point.scale);
    return fmt::format(", {:g} … {:g}", std::max(least, min), std::min(most, max));
  }
  if (is_float(type)) return {};
  return codec::with_number(type, [](auto zero) {
    using Ends = std::numeric_limits<decltype(zero)>;
    return fmt::format(", {} … {}", +Ends::lowest(), +Ends::max());
  });
}

}  // namespace

std::vector<std::string> identifiers(const std::vector<std::string_view>& names,
                                     Span<const std::string_view> taken, bool (*usable)(std::string_view)) {
  std::set<std::string, std::less<>> used(taken.begin(), taken.end());
  std::vector<bool> stays(names.size());  // what a name is already goes to no other one
  for (std::size_t i = 0; i < names.size(); ++i)
    stays[i] = usable(names[i]) && used.insert(std::string(names[i])).second;
  std::map<std::string, std::size_t> tried;  // how many '_' were behind the last one of that name
  std::vector<std::string> out;
  for (std::size_t i = 0; i < names.size(); ++i) {
    std::string one(names[i]);
    if (!stays[i]) {
      std::replace_if(
          one.begin(), one.end(), [](char c) { return !is_name_character(c); }, '_');
      std::size_t& more = tried[one];
      one.append(more, '_');
      for (; !usable(one) || used.count(one) != 0; ++more) one += '_';
      used.insert(one);
    }
    out.push_back(std::move(one));
  }
  return out;
}

std::vector<std::string_view> names_of(const Map& map) {
  std::vector<std::string_view> names;
  for (const Point& point : map.points) names.push_back(point.name);
  return names;
}

std::vector<std::string_view> names_of(const Point& point) {
  std::vector<std::string_view> names;
  for (const NamedValue& named : point.values) names.push_back(named.name);
  return names;
}

std::string_view point_class(Access access) {
  switch (access) {
    case Access::read: return "Input";
    case Access::write: return "Command";
    case Access::read_write: return "Output";
  }
  return {};
}

std::vector<std::string> members(const Map& map) { return cpp_names(names_of(map)); }

std::vector<std::string> value_names(const Point& point) { return cpp_names(names_of(point)); }

std::string cpp_number(const Point& point) { return std::string(cpp_number(point.format.type)); }

std::string cpp_type(const Point& point) {
  const std::string one(point.scale.present() ? "double" : cpp_number(point.format.type));
  return point.count == 1 ? one : fmt::format("::std::array<{}, {}>", one, point.count);
}

std::string place(const Point& point) {
  std::string out = fmt::format("{} {}", to_string(point.table), point.address);
  if (range(point).count() > 1) out += fmt::format("-{}", range(point).last());
  return is_partial(point) ? fmt::format("{}, {}", out, part_text(point)) : out;
}

std::string documentation(const Point& point) {
  std::string out = point.description.empty() ? "" : comment(point.description) + ": ";
  out += to_string(point.format.type);
  if (point.count > 1) out += fmt::format(" × {}", point.count);
  out += value_range(point);
  if (!point.units.empty()) out += " " + comment(point.units);
  if (point.scale.has_exponent()) out += fmt::format(" × 10^{}", comment(point.scale.exponent_of));
  return out + fmt::format("; {}.", place(point));
}

}  // namespace coupler::generate
