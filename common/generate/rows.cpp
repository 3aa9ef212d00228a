// SPDX-License-Identifier: Apache-2.0
#include "common/generate/rows.hpp"

#include <fmt/format.h>

#include "common/codec/decimal.hpp"
#include "common/generate/literal.hpp"

namespace coupler::generate {
namespace {

using codec::Encoding;
using codec::Format;
using codec::Half;
using codec::Type;

std::string_view enumerator(Access access) {
  switch (access) {
    case Access::read: return "Access::read";
    case Access::write: return "Access::write";
    case Access::read_write: return "Access::read_write";
  }
  return {};
}

std::string_view enumerator(Safe safe) {
  switch (safe) {
    case Safe::off: return "Safe::off";
    case Safe::on: return "Safe::on";
    case Safe::hold: return "Safe::hold";
  }
  return {};
}

std::string_view enumerator(Bias bias) {
  switch (bias) {
    case Bias::as_is: return "Bias::as_is";
    case Bias::none: return "Bias::none";
    case Bias::pull_up: return "Bias::pull_up";
    case Bias::pull_down: return "Bias::pull_down";
  }
  return {};
}

std::string_view enumerator(Drive drive) {
  switch (drive) {
    case Drive::push_pull: return "Drive::push_pull";
    case Drive::open_drain: return "Drive::open_drain";
    case Drive::open_source: return "Drive::open_source";
  }
  return {};
}

std::string_view enumerator(Encoding encoding) {
  switch (encoding) {
    case Encoding::utf8: return "Encoding::utf8";
    case Encoding::ascii: return "Encoding::ascii";
    case Encoding::latin1: return "Encoding::latin1";
  }
  return {};
}

std::string_view enumerator(Edge edge) {
  switch (edge) {
    case Edge::rising: return "Edge::rising";
    case Edge::falling: return "Edge::falling";
    case Edge::both: return "Edge::both";
  }
  return {};
}

std::string_view enumerator(HostOptions::Publish publish) {
  return publish == HostOptions::Publish::always ? "HostOptions::Publish::always"
                                                 : "HostOptions::Publish::on_change";
}

std::string_view enumerator(HostOptions::WriteFunction function) {
  switch (function) {
    case HostOptions::WriteFunction::automatic: return "HostOptions::WriteFunction::automatic";
    case HostOptions::WriteFunction::single: return "HostOptions::WriteFunction::single";
    case HostOptions::WriteFunction::multiple: return "HostOptions::WriteFunction::multiple";
  }
  return {};
}

std::string_view enumerator(HostOptions::WriteQueue queue) {
  return queue == HostOptions::WriteQueue::latest ? "HostOptions::WriteQueue::latest"
                                                  : "HostOptions::WriteQueue::every";
}

/// Fields after the last one that differs from its default are left out.
std::string format(const Format& format) {
  const Format usual;
  std::string out = fmt::format("{{Type::{}", to_string(format.type));
  const bool text = format.length != usual.length || format.encoding != usual.encoding;
  const bool part = text || format.half != usual.half || format.bit != usual.bit;
  if (part || format.order != usual.order)
    out += fmt::format(", Order::{}", codec::to_string(format.order, false));
  if (part)
    out += fmt::format(", {}, {}", format.half == Half::high ? "Half::high" : "Half::low", format.bit);
  if (text) out += fmt::format(", {}, {}", format.length, enumerator(format.encoding));
  return out + '}';
}

std::string registers(Span<const std::uint16_t> words) {
  if (words.empty()) return "{}";
  std::string out;
  for (const std::uint16_t word : words) out += fmt::format("{}0x{:04X}", out.empty() ? "" : ", ", word);
  return fmt::format("registers<{}>", out);
}

std::string line(const Line& line) {
  if (!line.present()) return "{}";
  return fmt::format("{{{}, {}, {}, {}, {}, {}, {}us}}", literal(line.chip), line.offset, literal(line.name),
                     line.active_low, enumerator(line.bias), enumerator(line.drive), line.debounce.count());
}

std::string edge(const EdgeOf& edge) {
  return edge.present() ? fmt::format("{{{}, {}}}", literal(edge.input), enumerator(edge.edge)) : "{}";
}

std::string iio(const Iio& iio) {
  return iio.present() ? fmt::format("{{{}, {}}}", literal(iio.device), literal(iio.channel)) : "{}";
}

std::string pwm(const Pwm& pwm) {
  return pwm.present() ? fmt::format("{{{}, {}, {}ns}}", literal(pwm.chip), pwm.channel, pwm.period.count())
                       : "{}";
}

std::string deadman(const HostOptions::Deadman& deadman) {
  return deadman.present() ? fmt::format("{{{}ms, {}}}", deadman.timeout.count(), registers(deadman.value))
                           : "{}";
}

/// As a row says it; those of most points say "{}".
std::string host(const HostOptions& options) {
  const auto text = [](const HostOptions& o) {
    return fmt::format("{{{}, {}, {}, {}ms, {}, {},\n      {}, {}, {}, {}}}", codec::decimal(o.rate),
                       enumerator(o.publish), codec::decimal(o.deadband), o.max_interval.count(), o.latch,
                       o.queue_size, enumerator(o.write_function), enumerator(o.write_queue), o.verify_write,
                       deadman(o.deadman));
  };
  std::string out = text(options);
  return out == text(HostOptions{}) ? "{}" : out;
}

/// What few points have behind counter and latched: count, scale, iio, pwm, safe registers, read address,
/// host.
std::string rest(const Point& point) {
  return fmt::format("{}, {{{}, {}}}, {}, {}, {}, {}, {}", point.count, codec::decimal(point.scale.gain),
                     codec::decimal(point.scale.offset), iio(point.iio), pwm(point.pwm),
                     registers(point.safe_value),
                     point.read_address ? fmt::format("::std::uint16_t{{{}}}", *point.read_address) : "{}",
                     host(point.host));
}

/// All that most points do not have.
std::string extras(const Point& point) {
  const std::string edges = fmt::format(", {}, {}", edge(point.counter), edge(point.latched));
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
      "    {{{}, Table::{}, {}, {}, {},\n"
      "     {}, {}, {},\n"
      "     {}, {}{}}},\n",
      what, place(point), literal(point.name), to_string(point.table), point.address, format(point.format),
      enumerator(point.access), registers(point.initial), enumerator(point.safe), line(point.line),
      literal(point.description), literal(point.units), extras(point));
}

std::string row(const SimWire& wire) {
  return fmt::format("    {{{}, {}, {}, {}us}},\n", literal(wire.from), literal(wire.to), wire.invert,
                     wire.square.count());
}

std::string row(const Unreadable& area) {
  return fmt::format("    {{Table::{}, Range::of({}, {})}},\n", to_string(area.table), area.range.start(),
                     area.range.count());
}

std::string row(const WatchdogSequences::Write& write) {
  return fmt::format("    {{Table::{}, {}, {}, {}}},\n", to_string(write.table), write.address, write.value,
                     write.if_different);
}

std::string row(std::string_view address) { return fmt::format("    {},\n", literal(address)); }

}  // namespace coupler::generate
