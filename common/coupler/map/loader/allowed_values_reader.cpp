// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <string_view>
#include <unordered_set>
#include <vector>

#include <fmt/format.h>

#include "coupler/codec/scale.hpp"
#include "coupler/codec/value.hpp"
#include "coupler/map/loader/point_reader.hpp"
#include "coupler/map/loader/scalar.hpp"

namespace coupler::loader {
namespace {

constexpr std::string_view names_form = "write it as in 'values: {0: idle, 1: running}'";

/// The bound is a value of the point: of the type, and not between two steps of a scaled integer.
void check_bound(std::string_view key, double bound, const Reader& reader, const Point& point,
                 const Context& context) {
  const Entry* entry = reader.find(key);
  if (entry == nullptr) return;
  // 65535 × 0.001 - 40 is not quite 25.535.
  const double rounding = codec::is_float(point.format.type) ? 0 : 1e-6 * std::fabs(point.scale.gain);
  const auto [least, most] = codec::published_range(point.format, point.scale);
  if (bound < least - rounding || bound > most + rounding) {
    context.problems.error(entry->at,
                           fmt::format("'{}' is {:.15g}, but {} is published from {:.15g} to {:.15g}", key,
                                       bound, shown(point.name), least, most),
                           fmt::format("write a number in that range, or remove '{}'", key));
    return;
  }
  if (codec::is_float(point.format.type)) return;
  const double nearest = codec::nearest_published(bound, point.format, point.scale);
  if (std::fabs(nearest - bound) > rounding)
    context.problems.error(entry->at,
                           fmt::format("'{}' is {:.15g}, which is not a value of {}; the nearest is {:.15g}",
                                       key, bound, shown(point.name), nearest),
                           fmt::format("write '{}: {:.15g}'", key, nearest));
}

bool check_type(const Reader& reader, const Point& point, const Context& context) {
  bool good = true;
  const auto refuse = [&](std::string_view key, std::string_view what, std::string_view remedy) {
    const Entry* entry = reader.find(key);
    if (entry == nullptr) return;
    good = false;
    context.problems.error(entry->key_at, fmt::format("'{}' does not apply to {}", key, what),
                           std::string(remedy));
  };
  const std::string_view type = to_string(point.format.type);
  if (!codec::is_scalable(point.format.type)) {
    for (const std::string_view key : {"min", "max"})
      refuse(key, type, "use a type that is a number: SINT to ULINT, REAL or LREAL");
    refuse("values", type, "use a type that is a whole number: SINT to ULINT");
  } else if (codec::is_float(point.format.type)) {
    refuse("values", type, "use a type that is a whole number: SINT to ULINT");
  } else if (point.scale.present()) {
    refuse("values", "a point with a 'scale'", "remove 'scale': names are for whole numbers");
  }
  return good;
}

/// Remembers what one `values` has named so far: it may have a name for each number of a type.
struct Seen {
  std::unordered_set<std::int64_t> values;
  std::unordered_set<std::string_view> names;
};

std::string_view words_of(Forbidden why) {
  if (why == Forbidden::invalid) return "'invalid', so it cannot be written";
  return why == Forbidden::below_min ? "below 'min'" : "above 'max'";
}

/// An input may have a name for what its device gives for no value.
bool is_forbidden_name(Forbidden why, const Point& point) {
  return why != Forbidden::invalid || is_writable(point);
}

/// One entry of `values`; false if it is wrong.
bool read_name(const Entry& entry, const Point& point, std::vector<NamedValue>& names, Seen& seen,
               const Context& context) {
  const auto wrong = [&](Position at, std::string what, std::string remedy) {
    context.problems.error(at, std::move(what), std::move(remedy));
    return false;
  };
  const auto value = parse_integer(entry.key);
  if (!value)
    return wrong(entry.key_at,
                 fmt::format("'values' has {} where a whole number must stand", shown(entry.key)),
                 std::string(names_form) + ": the number first");
  if (entry.kind != Entry::Kind::scalar || !is_value_name(entry.text))
    return wrong(entry.at, fmt::format("{} cannot be the name of a value", shown(entry)),
                 "use letters, digits and '_', a letter first");
  std::array<std::uint16_t, 4> registers{};
  if (const auto held = codec::encode(codec::Value{*value}, point.format, registers.data()); !held)
    return wrong(entry.key_at, fmt::format("'values': {}", held.error()),
                 point.format.bits != 0 ? "write a value that these bits can hold"
                                        : "write a value that the type can hold");
  const bool is_new_value = seen.values.insert(*value).second;
  const bool is_new_name = seen.names.insert(entry.text).second;
  if (!is_new_value || !is_new_name)
    return wrong(entry.key_at, fmt::format("'values' has '{}' twice", is_new_value ? entry.text : entry.key),
                 "keep one of the two");
  if (const auto why = why_forbidden(point, registers.data()); why && is_forbidden_name(*why, point))
    return wrong(entry.key_at, fmt::format("'values' names {}, which is {}", *value, words_of(*why)),
                 "change one of the two");
  names.push_back({*value, context.map.keep(entry.text)});
  return true;
}

void read_names(const Entry& entry, Point& point, const Context& context) {
  if (entry.kind != Entry::Kind::map || entry.children.empty()) {
    context.problems.error(entry.at,
                           fmt::format("'values' must be a map of numbers and names, not {}", shown(entry)),
                           std::string(names_form));
    return;
  }
  std::vector<NamedValue> names;
  Seen seen;
  bool good = true;
  for (const Entry& each : entry.children) good = read_name(each, point, names, seen, context) && good;
  if (!good) return;
  std::sort(names.begin(), names.end(),
            [](const NamedValue& a, const NamedValue& b) { return a.value < b.value; });
  point.values = context.map.keep(names);
}

void check_duty_cycle(std::string_view key, Span<const std::uint16_t> registers, const Reader& reader,
                      const Point& point, const Context& context) {
  const double percent = codec::published(registers.data(), point.format, point.scale);
  if (is_duty_cycle(percent)) return;
  const Entry* entry = reader.find(key);
  context.problems.error(entry != nullptr ? entry->at : reader.find("pwm")->key_at,
                         fmt::format("the '{}' value of {} is {:g}, but a PWM takes 0 to 100 %", key,
                                     shown(point.name), percent),
                         fmt::format("write '{}' with a value in that range", key));
}

}  // namespace

void read_allowed_values(const Reader& reader, Point& point, const Context& context) {
  if (!check_type(reader, point, context) || point.scale.has_exponent()) return;
  const std::size_t errors = context.problems.errors();
  Bounds bounds;
  reader.fields(bounds);
  if (bounds.min > bounds.max)
    context.problems.error(reader.find("max")->at,
                           fmt::format("'max' is {:g}, below 'min', which is {:g}", bounds.max, bounds.min),
                           "exchange the two, or change one");
  check_bound("min", bounds.min, reader, point, context);
  check_bound("max", bounds.max, reader, point, context);
  if (context.problems.errors() != errors) return;
  point.bounds = bounds;
  if (const Entry* names = reader.find("values")) read_names(*names, point, context);
}

void check_start(const Reader& reader, const Point& point, const Context& context) {
  if (!is_writable(point) || !is_analogue(point)) return;
  constexpr std::array<std::uint16_t, 4> zero{};
  const auto check = [&](std::string_view key, bool given, std::string_view when) {
    const auto forbidden = find_forbidden(point, zero.data());
    if (given || !forbidden) return;
    const Entry* channel = reader.find(point.iio.present() ? "iio" : "pwm");
    context.problems.error(channel->key_at,
                           fmt::format("{} is set to 0 {}, which {} not allow", shown(point.name), when,
                                       forbidden->why == Forbidden::invalid ? "'invalid' does"
                                       : point.values.empty()               ? "'min' and 'max' do"
                                                                            : "its 'values' do"),
                           fmt::format("add '{}' with a value that is allowed", key));
  };
  check("initial", !point.initial.empty(), "at the start");
  check("safe", point.safe == Safe::hold || !point.safe_value.empty(), "when nobody is in command");
  if (!point.pwm.present()) return;
  check_duty_cycle("initial", point.initial.empty() ? Span<const std::uint16_t>(zero) : point.initial, reader,
                   point, context);
  if (!point.safe_value.empty()) check_duty_cycle("safe", point.safe_value, reader, point, context);
}

}  // namespace coupler::loader
