// SPDX-License-Identifier: Apache-2.0
#include "coupler/generate/rows.hpp"

#include <fmt/format.h>

#include "coupler/generate/code.hpp"
#include "coupler/generate/literal.hpp"

namespace coupler::generate {
namespace {

using codec::Format;
using codec::Half;
using codec::Type;

/// Fields after the last one that differs from its default are left out.
std::string format(const Format& format) {
  const Format usual;
  std::string out = fmt::format("{{{}", enumerator(format.type));
  const bool text = format.length != usual.length || format.encoding != usual.encoding;
  const bool part = text || format.half != usual.half || format.bit != usual.bit;
  if (part || format.order != usual.order) out += fmt::format(", {}", enumerator(format.order));
  if (part) out += fmt::format(", {}, {}", enumerator(format.half), format.bit);
  if (text) out += fmt::format(", {}, {}", format.length, enumerator(format.encoding));
  return out + '}';
}

std::string registers(Span<const std::uint16_t> words) {
  if (words.empty()) return "{}";
  std::string out;
  for (const std::uint16_t word : words) out += fmt::format("{}0x{:04X}", out.empty() ? "" : ", ", word);
  return fmt::format("registers<{}>", out);
}

std::string deadman(const HostOptions::Deadman& deadman) {
  return deadman.present() ? fmt::format("{{{}ms, {}}}", deadman.timeout.count(), registers(deadman.value))
                           : "{}";
}

std::string host(const HostOptions& options) {
  if (has_defaults(options) && !options.deadman.present()) return "{}";
  return fmt::format("{{{}, {}}}", members(options), deadman(options.deadman));
}

/// What few points have behind counter and latched: count, scale, iio, pwm, safe registers, read address,
/// host.
std::string rest(const Point& point) {
  return fmt::format("{}, {}, {}, {}, {}, {}, {}", point.count, aggregate(point.scale), aggregate(point.iio),
                     aggregate(point.pwm), registers(point.safe_value),
                     point.read_address ? fmt::format("::std::uint16_t{{{}}}", *point.read_address) : "{}",
                     host(point.host));
}

/// All that most points do not have.
std::string extras(const Point& point) {
  const std::string edges = fmt::format(", {}, {}", aggregate(point.counter), aggregate(point.latched));
  const std::string more = rest(point);
  if (more != rest(Point{})) return edges + ",\n     " + more;
  return point.counter.present() || point.latched.present() ? edges : std::string();
}

}  // namespace

std::string place(const Point& point) {
  std::string out = fmt::format("{} {}", to_string(point.table), point.address);
  if (range(point).count() > 1) out += fmt::format("-{}", range(point).last());
  if (!is_partial(point)) return out;
  if (point.format.type == Type::BOOL) return out + fmt::format(", bit {}", point.format.bit);
  return out + (point.format.half == Half::high ? ", high byte" : ", low byte");
}

std::string row(const Point& point) {
  const std::string what = point.description.empty() ? "" : comment(point.description) + ": ";
  return fmt::format(
      "    // {}{}\n"
      "    {{{}, {}, {}, {}, {},\n"
      "     {}, {}, {},\n"
      "     {}, {}{}}},\n",
      what, place(point), literal(point.name), enumerator(point.table), point.address, format(point.format),
      enumerator(point.access), registers(point.initial), enumerator(point.safe), aggregate(point.line),
      literal(point.description), literal(point.units), extras(point));
}

std::string row(const SimWire& wire) { return fmt::format("    {},\n", aggregate(wire)); }

std::string row(const Unreadable& area) {
  return fmt::format("    {{{}, Range::of({}, {})}},\n", enumerator(area.table), area.range.start(),
                     area.range.count());
}

std::string row(const WatchdogSequences::Write& write) {
  return fmt::format("    {{{}, {}, {}, {}}},\n", enumerator(write.table), write.address, write.value,
                     write.if_different);
}

std::string row(std::string_view address) { return fmt::format("    {},\n", literal(address)); }

}  // namespace coupler::generate
