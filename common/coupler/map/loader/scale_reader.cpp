// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "coupler/codec/scale.hpp"
#include "coupler/map/loader/point_reader.hpp"
#include "coupler/map/loader/scalar.hpp"

namespace coupler::loader {
namespace {

constexpr std::string_view scale_value = "a number other than 0, or a map of 'gain' and 'offset'";

std::optional<double> bare_number(const Entry& entry) {
  return entry.kind == Entry::Kind::scalar && !entry.quoted ? parse_number(entry.text) : std::nullopt;
}

/// nullopt if the key is not there, or wrong.
std::optional<std::pair<double, double>> ends(const Reader& scale, std::string_view key) {
  const Entry* entry = scale.find(key);
  if (entry == nullptr) return std::nullopt;
  std::optional<double> first;
  std::optional<double> last;
  if (entry->kind == Entry::Kind::list && entry->children.size() == 2) {
    first = bare_number(entry->children[0]);
    last = bare_number(entry->children[1]);
  }
  if (!first || !last) {
    scale.refuse(key, fmt::format("'{}' must be two numbers in a list", key),
                 fmt::format("write it as in '{}: {}'", key, find_key(key, Section::scale)->example));
  } else if (*first == *last) {
    scale.refuse(key, fmt::format("'{}' has the same number twice", key), "write two different numbers");
  } else {
    return std::pair(*first, *last);
  }
  return std::nullopt;
}

/// `raw` and `value`: two points of a line, in place of gain and offset.
void read_ends(const Reader& reader, const codec::Format& format, codec::Scale& scale,
               const Context& context) {
  for (const auto& [key, other] : {std::pair("raw", "value"), std::pair("value", "raw")}) {
    if (!reader.has(key)) continue;
    if (!reader.has(other))
      return reader.refuse(key, fmt::format("'scale' has '{}' and no '{}'", key, other),
                           "write both, as in 'scale: {raw: [4000, 20000], value: [0, 10]}'");
    for (const char* factor : {"gain", "offset", "exponent_of"})
      if (reader.has(factor))
        return reader.refuse(
            factor, fmt::format("'{}' does not go with 'raw' and 'value', which determine it", factor),
            fmt::format("remove '{}', or 'raw' and 'value'", factor));
  }
  const auto raw = ends(reader, "raw");
  const auto value = ends(reader, "value");
  if (!raw || !value) return;
  const auto [least, most] = codec::published_range(format, {});
  if (std::min(raw->first, raw->second) < least || std::max(raw->first, raw->second) > most)
    context.problems.warning(reader.find("raw")->at,
                             fmt::format("'raw' has a number beyond those of {}, {:.15g} to {:.15g}",
                                         format.bits != 0 ? "its bits" : to_string(format.type), least, most),
                             format.bits != 0
                                 ? "write other numbers, or more 'bits'"
                                 : "write another type, as UINT for 0 to 65535, or other numbers");
  const double gain = (value->second - value->first) / (raw->second - raw->first);
  const double offset = value->first - raw->first * gain;
  if (gain == 0 || !std::isfinite(gain) || !std::isfinite(offset))
    return reader.refuse("value", "the line through 'raw' and 'value' is too steep or too flat",
                         "write other numbers");
  scale.gain = gain;
  scale.offset = offset;
}

}  // namespace

void read_scale(const Reader& reader, Point& point, const Context& context) {
  const Entry* entry = reader.find("scale");
  if (entry == nullptr) return;
  if (!codec::is_scalable(point.format.type)) {
    context.problems.error(entry->key_at,
                           fmt::format("'scale' does not apply to {}", to_string(point.format.type)),
                           "use a type that is a number: SINT to ULINT, REAL or LREAL");
    return;
  }
  codec::Scale scale;
  if (entry->kind == Entry::Kind::map) {
    const Reader inside(*entry, Section::scale, context);
    inside.fields(scale);
    read_ends(inside, point.format, scale, context);
    if (inside.has("exponent_of") && !scale.has_exponent())
      inside.wrong("exponent_of", "the name of a point");
    if (scale.gain == 0) inside.wrong("gain", "a number other than 0");
  } else if (const auto gain = bare_number(*entry)) {
    scale.gain = *gain;
    if (scale.gain == 0) reader.wrong("scale", scale_value);
  } else if (entry->kind == Entry::Kind::scalar && !entry->text.empty() && is_letter(entry->text[0])) {
    context.problems.error(entry->at, fmt::format("'scale' must be {}, not {}", scale_value, shown(*entry)),
                           fmt::format("write it as in 'scale: 0.1', or 'scale: {{exponent_of: {}}}' if that "
                                       "is the point with the exponent",
                                       entry->text.substr(0, 40)));
  } else {
    reader.wrong("scale", scale_value);
  }
  if (scale.gain == 0) return;
  point.scale = scale;
  if (!scale.has_exponent()) return;
  for (const std::string_view key : {"initial", "min", "max"})
    if (reader.has(key))
      reader.refuse(key,
                    fmt::format("'{}' does not go with 'exponent_of': only the device knows the scale", key),
                    "remove it");
}

}  // namespace coupler::loader
