// SPDX-License-Identifier: Apache-2.0
#include "coupler/map/loader/point_reader.hpp"

#include <fmt/format.h>

namespace coupler::loader {
namespace {

using Deadman = HostOptions::Deadman;
using WriteFunction = HostOptions::WriteFunction;

/// A key of this point that is wrong, and what to do.
struct Complaint {
  std::string_view key;
  std::string what;
  std::string remedy;
};

Deadman read_deadman(const Entry& entry, const Point& point, const Context& context) {
  Deadman deadman;
  const Reader reader(entry, Section::deadman, context);
  const Entry* value = reader.find("value");
  if (!reader.missing().empty()) {
    if (!reader.lacks(reader.missing())) return deadman;
    context.problems.error(entry.key_at, "'deadman' needs a 'timeout' and a 'value'",
                           "write it as in 'deadman: {timeout: 1s, value: 0}'");
    return deadman;
  }
  deadman.value = read_value("value", *value, point, context);
  reader.duration("timeout", deadman.timeout);
  return deadman;
}

bool fits_one_request(const Point& point) { return range(point).count() == 1; }

std::vector<Complaint> complaints(const Reader& reader, const Point& point) {
  std::vector<Complaint> found;
  const bool on_change = point.host.publish == HostOptions::Publish::on_change;
  const auto refuse = [&](std::string_view key, std::string what, std::string remedy) {
    if (reader.has(key)) found.push_back({key, std::move(what), std::move(remedy)});
  };
  const auto refuse_about = [&](About about, std::string_view done, std::string_view access) {
    const auto what = [&](std::string_view key) {
      return fmt::format("'{}' is for a point that is {}, but this one has 'access: {}'", key, done, access);
    };
    for_each_field(point.host, [&](const auto& field, const auto&) {
      const bool known = find_key(field.key, section_of(point.table)) != nullptr;
      if (field.about == about && known) refuse(field.key, what(field.key), "remove it");
    });
    if (about == About::writing) refuse("deadman", what("deadman"), "remove it");
  };
  if (!is_readable(point)) refuse_about(About::reading, "read", "write");
  if (!is_readable(point) && point.host.verify_write)
    refuse("verify_write", "'verify_write' reads the point back, but this one has 'access: write'",
           "remove one of the two");
  if (is_pulsed(point) && point.host.verify_write)
    refuse("verify_write", "'verify_write' reads the point back, when its 'pulse' may be over",
           "remove one of the two");
  if (!on_change)
    refuse("max_interval", "'max_interval' needs 'publish: on_change'", "add that, or remove 'max_interval'");
  if (is_readable(point) && point.count > 1 && point.host.stamped)
    refuse("stamped", "'stamped' is for single values, but this point is an array",
           "remove it, or give each value a point of its own");
  if (is_writable(point.table) && !is_writable(point)) refuse_about(About::writing, "written", "read");
  return found;
}

void check_deadband(const Reader& reader, const Point& point, const Context& context) {
  const Entry* deadband = holds_bits(point.table) ? nullptr : reader.find("deadband");
  if (deadband == nullptr || !is_readable(point)) return;
  if (!codec::is_scalable(point.format.type))
    context.problems.error(deadband->key_at,
                           fmt::format("'deadband' does not apply to {}", to_string(point.format.type)),
                           "remove it; it is for numbers: SINT to ULINT, REAL and LREAL");
  else if (point.host.publish != HostOptions::Publish::on_change)
    context.problems.error(deadband->key_at, "'deadband' needs 'publish: on_change'",
                           "add that, or remove 'deadband'");
}

/// Function codes 5 and 6 write one address.
void check_write_function(const Reader& reader, Point& point, const Context& context) {
  if (point.host.write_function != WriteFunction::single || fits_one_request(point)) return;
  if (const Entry* own = reader.find("write_function"))
    context.problems.error(own->at,
                           fmt::format("{} has {} addresses, function codes 5 and 6 write one",
                                       shown(point.name), range(point).count()),
                           "write 'multiple', or remove it");
  point.host.write_function = WriteFunction::automatic;
}

}  // namespace

HostDefaults read_host_defaults(const Reader& top) {
  HostDefaults defaults;
  const auto reader = top.inside("defaults", "a map of what the host does with points");
  if (!reader) return defaults;
  reader->fields(defaults.options);
  defaults.deadman = reader->find("deadman");
  return defaults;
}

void read_host_options(const Reader& reader, const HostDefaults& defaults, DraftPoint& draft,
                       const Context& context) {
  Point& point = draft.point;
  HostOptions& options = point.host;
  options = defaults.options;
  reader.fields(options);
  const bool number = !holds_bits(point.table) && codec::is_scalable(point.format.type);
  if (!number) options.deadband = 0;
  for (Complaint& wrong : complaints(reader, point))
    context.problems.error(reader.find(wrong.key)->key_at, std::move(wrong.what), std::move(wrong.remedy));
  if (point.count > 1 || !is_readable(point)) options.stamped = false;
  if (!draft.placed) return;
  check_deadband(reader, point, context);
  if (!is_writable(point)) {
    for_each_field(options, HostOptions{}, [](const auto& field, auto& value, const auto& usual) {
      if (field.about == About::writing) value = usual;
    });
    return;
  }
  if (!is_readable(point) || is_pulsed(point)) options.verify_write = false;
  check_write_function(reader, point, context);
  const Entry* own = reader.find("deadman");
  if (const Entry* deadman = own != nullptr ? own : defaults.deadman)
    options.deadman = read_deadman(*deadman, point, context);
}

}  // namespace coupler::loader
