// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/cli/probe_call.hpp"

#include <utility>

#include <fmt/format.h>

#include "coupler/map/loader/scalar.hpp"
#include "coupler/map/node_address.hpp"

namespace coupler::cli {
namespace {

/// Units on Modbus/TCP; 248 to 254 are reserved.
bool is_unit(std::uint64_t unit) { return unit <= 247 || unit == 255; }

/// "5" or "1-247".
bool add_units(std::string_view text, std::vector<std::uint8_t>& units) {
  const auto dash = text.find('-');
  const auto first = loader::parse_unsigned(text.substr(0, dash));
  const auto last = dash == std::string_view::npos ? first : loader::parse_unsigned(text.substr(dash + 1));
  if (!first || !last || *first > *last || !is_unit(*first) || !is_unit(*last)) return false;
  for (auto unit = *first; unit <= *last; ++unit)
    if (is_unit(unit)) units.push_back(static_cast<std::uint8_t>(unit));
  return true;
}

/// Empty: those that are asked by default.
tl::expected<std::vector<std::uint8_t>, WrongCall> units_of(const ProbeArguments& arguments,
                                                            const NodeAddress& where, bool has_unit) {
  std::vector<std::uint8_t> units;
  for (const std::string& text : arguments.units)
    if (!add_units(text, units))
      return tl::make_unexpected(
          WrongCall{fmt::format("'{}' is not a unit id", text), "give 0 to 247 or 255, as --units 1-10,255"});
  if (!units.empty()) return units;
  if (has_unit && !is_unit(where.unit))
    return tl::make_unexpected(
        WrongCall{fmt::format("unit {} is reserved", where.unit), "give 0 to 247 or 255"});
  if (has_unit) units.push_back(where.unit);
  return units;
}

tl::expected<std::vector<scan::KnownValue>, WrongCall> known_values(const std::vector<std::string>& texts) {
  std::vector<scan::KnownValue> known;
  for (const std::string& text : texts) {
    auto value = scan::parse_known_value(text);
    if (!value)
      return tl::make_unexpected(WrongCall{"--known: " + value.error(), "see `coupler probe --help`"});
    for (const scan::KnownValue& other : known)
      if (!other.name.empty() && other.name == value->name)
        return tl::make_unexpected(WrongCall{fmt::format("two values are named '{}'", other.name),
                                             "give each --known its own name"});
    known.push_back(std::move(*value));
  }
  return known;
}

}  // namespace

tl::expected<std::unique_ptr<ProbeCall>, WrongCall> understand(const ProbeArguments& arguments) {
  auto call = std::make_unique<ProbeCall>();
  call->address = node_argument(arguments.host);
  const auto where = parse_node_address(call->address);
  if (!where) return tl::make_unexpected(WrongCall{where.error().what, where.error().remedy});
  if (arguments.from > arguments.to)
    return tl::make_unexpected(
        WrongCall{fmt::format("--from {} is behind --to {}", arguments.from, arguments.to), "exchange them"});
  const auto slash = call->address.find('/', std::string("tcp://").size());
  auto units = units_of(arguments, *where, slash != std::string::npos && slash + 1 < call->address.size());
  if (!units) return tl::make_unexpected(units.error());
  auto known = known_values(arguments.known);
  if (!known) return tl::make_unexpected(known.error());
  call->connection = {where->host, where->port, where->unit,
                      std::chrono::milliseconds(static_cast<long>(arguments.timeout * 1000))};
  if (!units->empty()) call->task.units = std::move(*units);
  call->task.stride = arguments.stride;
  call->task.rate = arguments.rate;
  call->task.window = modbus::Range::of(arguments.from, arguments.to - arguments.from + 1);
  call->known = std::move(*known);
  return call;
}

}  // namespace coupler::cli
