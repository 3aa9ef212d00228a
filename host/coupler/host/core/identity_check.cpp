// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/core/identity_check.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "coupler/base/shortened.hpp"
#include "coupler/map/fields.hpp"
#include "coupler/map/fingerprint.hpp"

namespace coupler::host {
namespace {

using Verdict = Identity::Verdict;

Identity unreadable(std::uint64_t fingerprint, const std::string& why) {
  return {Verdict::different, fingerprint, {"the device's map cannot be compared: " + why}, {}};
}

/// The node does not give its map. Other exceptions pass: it is busy, or behind a gateway and away.
bool is_refusal(const Error& error) {
  const ExceptionReply* exception = exception_in(error);
  return exception != nullptr && exception->code <= modbus::Exception::server_device_failure;
}

Identity compare(const Map& known, const Map& device, std::uint64_t fingerprint) {
  Identity identity{Verdict::superset, fingerprint, {}, diff(known, device)};
  for (const Difference& difference : identity.points) {
    if (is_breaking(difference.kind)) identity.verdict = Verdict::different;
    identity.differences.push_back(to_string(difference));
  }
  return identity;
}

}  // namespace

std::string difference_text(const Map& known, const Identity& identity) {
  std::string text = fmt::format("the map differs from the device's: fingerprint {} here, {} in the device",
                                 fingerprint_text(known.fingerprint), fingerprint_text(identity.fingerprint));
  constexpr std::size_t most = 20;
  constexpr std::size_t longest = 300;
  const std::size_t shown = std::min(identity.differences.size(), most);
  for (std::size_t i = 0; i < shown; ++i) text += "\n  " + shortened(identity.differences[i], longest);
  if (identity.differences.size() > most)
    text += fmt::format("\n  and {} more; `coupler diff` shows them all", identity.differences.size() - most);
  return text;
}

std::vector<ForeignPoint> foreign_points(const Map& known, const Identity& identity) {
  std::vector<ForeignPoint> found;
  if (identity.verdict != Verdict::different) return found;
  for (const Difference& difference : identity.points) {
    if (!is_breaking(difference.kind)) continue;
    const bool is_missing = difference.kind == Difference::Kind::missing;
    const auto point = static_cast<std::uint32_t>(find(known, difference.point) - known.points.begin());
    found.push_back({point, is_missing ? "not in the device's map"
                                       : "different in the device's map: " + difference.what});
  }
  if (identity.points.empty())
    for (std::uint32_t point = 0; point < known.points.size(); ++point)
      found.push_back({point, "the device's map cannot be compared"});
  return found;
}

std::string line_remedy(const Connection& line) {
  if (!line.serial.present()) return "check power, A and B, 'unit', and the gateway's rate and parity";
  return fmt::format(
      "check power, A and B, 'unit', 'baud' and 'parity' (it was asked at {}); `coupler probe {}/{}` tries "
      "the usual "
      "ones",
      rate_and_parity(line.serial), line.serial.device, line.unit);
}

std::string silence_text(const Map& known, const Error& error) {
  if (known.connection.is_rtu() && !is_unit_away(error))
    return fmt::format(
        "unit {} does not answer the request for its identity: {}; {}. If it is a module that ignores "
        "addresses it does not have, or answers nonsense, give its map 'verify: off', or start with --verify "
        "off (a client: Options::verify)",
        known.connection.unit, to_string(error), line_remedy(known.connection));
  if (is_closed(error))
    return fmt::format(
        "the device accepts connections, but instead of answering the request for its identity {}; it may "
        "take none "
        "from "
        "this machine ('allow' of a coupler-node), have as many as it can, or be starting. If it is a "
        "foreign device "
        "that does so with addresses it does not have, give its map 'verify: off', or start with --verify "
        "off "
        "(a client: Options::verify)",
        to_string(error));
  return fmt::format(
      "{}, but unit {} does not answer the request for its identity: {}; {}. If it is a foreign device that "
      "ignores addresses it does not have, or answers nonsense, give its map 'verify: off', or start with "
      "--verify off (a client: Options::verify)",
      is_unit_away(error) ? "the gateway answers" : "the device accepts connections", known.connection.unit,
      to_string(error), silent_unit_remedy);
}

Result<Identity> check_identity(Link& link, const Map& known, const MapLoader& load) {
  const auto read = read_identity(link);
  if (!read) return tl::make_unexpected(read.error());
  if (!read->has_value()) return Identity{};
  const identity::Head& head = **read;
  if (head.fingerprint == known.fingerprint) return Identity{Verdict::equal, head.fingerprint, {}, {}};

  const auto text = fetch_map_text(link, head.map_size);
  if (!text) {
    if (!is_refusal(text.error())) return tl::make_unexpected(text.error());
    return unreadable(
        head.fingerprint,
        to_string(text.error()) + (is_no_right(text.error())
                                       ? ": it gives its map only to clients that may read every point"
                                       : ""));
  }
  const auto device = load_node_map(*text, head, load);
  if (!device) return unreadable(head.fingerprint, device.error());
  return compare(known, (*device)->map(), head.fingerprint);
}

}  // namespace coupler::host
