// SPDX-License-Identifier: Apache-2.0
#include "common/map/loader/scale_reader.hpp"

#include <fmt/format.h>

#include "common/map/loader/scalar.hpp"

namespace coupler::loader {
namespace {

constexpr std::string_view expected = "a number other than 0, or a map of 'gain' and 'offset'";

std::optional<double> bare_number(const Entry& entry) {
  return entry.kind == Entry::Kind::scalar && !entry.quoted ? parse_number(entry.text) : std::nullopt;
}

}  // namespace

void read_scale(const Reader& reader, Point& point, Context& context) {
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
    inside.number("gain", scale.gain);
    inside.number("offset", scale.offset);
    if (scale.gain == 0) inside.wrong("gain", "a number other than 0");
  } else if (const auto gain = bare_number(*entry)) {
    scale.gain = *gain;
    if (scale.gain == 0) reader.wrong("scale", expected);
  } else {
    reader.wrong("scale", expected);
  }
  if (scale.gain != 0) point.scale = scale;
}

}  // namespace coupler::loader
