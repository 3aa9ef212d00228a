// SPDX-License-Identifier: Apache-2.0
#include "coupler/tools/place_argument.hpp"

#include <sys/stat.h>
#include <sys/sysmacros.h>

#include <filesystem>
#include <string_view>
#include <system_error>

#include <fmt/format.h>

#include "coupler/base/enumeration.hpp"
#include "coupler/base/starts_with.hpp"

namespace coupler::tools {
namespace {

bool ends_in(std::string_view text, std::string_view end) {
  return text.size() >= end.size() && text.substr(text.size() - end.size()) == end;
}

/// Returns whether this is the absolute path of a device that can be a serial line, unlike /dev/null or
/// /dev/gpiochip0. A pseudo-terminal has no entry in /sys.
bool can_be_a_serial_line(const std::string& path) {
  struct stat status {};
  if (!starts_with(path, "/") || ::stat(path.c_str(), &status) != 0 || !S_ISCHR(status.st_mode)) return false;
  std::error_code ignored;
  const auto subsystem = std::filesystem::read_symlink(
      fmt::format("/sys/dev/char/{}:{}/subsystem", major(status.st_rdev), minor(status.st_rdev)), ignored);
  return subsystem.empty() || subsystem.filename() == "tty";
}

}  // namespace

bool has_name_of_map(const std::string& argument) {
  if (names_a_node(argument)) return false;
  for (const std::string_view end : {".yaml", ".yml", ".json"})
    if (ends_in(argument, end)) return true;
  return argument == "-";
}

bool can_be_a_device(const std::string& argument) {
  if (names_a_node(argument)) return true;
  std::error_code ignored;
  if (std::filesystem::exists(argument, ignored)) return can_be_a_serial_line(argument);
  if (argument.empty() || has_name_of_map(argument)) return false;
  if (starts_with(argument, "/")) return starts_with(argument, "/dev/");
  return argument.find('/') == std::string::npos || parse_node_address(node_argument(argument)).has_value();
}

tl::expected<Place, Failure> get_place(const std::string& argument, const TlsTexts& tls) {
  if (has_name_of_map(argument))
    return fail(bad_call, fmt::format("'{}' is a map, and this asks a device", argument),
                "give HOST[:PORT][/UNIT] or /dev/ttyUSB0[/UNIT]");
  Place place{std::make_shared<const std::string>(node_argument(argument)), {}, {}};
  const auto node = parse_node_address(*place.text);
  if (!node) return fail(bad_call, node.error().what, node.error().remedy);
  place.node = *node;
  place.connection = found_at({}, *node).connection;
  if (auto problem = use_tls_options(*node, tls, place.connection.tls))
    return tl::make_unexpected(*std::move(problem));
  return place;
}

std::string as_argument(const std::string& place) {
  constexpr std::string_view tcp = "tcp://";
  if (place.find_first_of("?&") != std::string::npos) return fmt::format("'{}'", place);
  return starts_with(place, tcp) ? place.substr(tcp.size()) : place;
}

std::string as_argument(const Connection& where) {
  const std::string place = node_address_text(where);
  const Serial& line = where.serial;
  if (!line.present()) return as_argument(place);
  return as_argument(fmt::format("{}?baud={}&parity={}&stop_bits={}{}", place, line.baud,
                                 to_string(line.parity), line.stop_bits, line.rs485 ? "&rs485=true" : ""));
}

}  // namespace coupler::tools
