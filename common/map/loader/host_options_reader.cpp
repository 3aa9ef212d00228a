// SPDX-License-Identifier: Apache-2.0
#include "common/map/loader/host_options_reader.hpp"

#include <fmt/format.h>

#include "common/map/loader/value_reader.hpp"

namespace coupler::loader {
namespace {

using Deadman = HostOptions::Deadman;
using WriteFunction = HostOptions::WriteFunction;

/// What is wrong with a key of this point, and what to do.
struct Complaint {
  std::string_view key;
  std::string what;
  std::string remedy;
};

void read_publishing(const Reader& reader, HostOptions& options) {
  reader.number("rate", options.rate);
  reader.choice("publish", {HostOptions::Publish::always, HostOptions::Publish::on_change}, options.publish);
  reader.duration("max_interval", options.max_interval);
  reader.boolean("latch", options.latch);
  reader.integer("queue_size", options.queue_size);
}

void read_writing(const Reader& reader, HostOptions& options) {
  reader.choice("write_function", {WriteFunction::single, WriteFunction::multiple}, options.write_function);
  reader.boolean("verify_write", options.verify_write);
  reader.choice("write_queue", {HostOptions::WriteQueue::latest, HostOptions::WriteQueue::every},
                options.write_queue);
}

Deadman read_deadman(const Entry& entry, const Point& point, Context& context) {
  Deadman deadman;
  const Reader reader(entry, Section::deadman, context);
  const Entry* value = reader.find("value");
  if (!reader.missing().empty()) {
    context.problems.error(entry.key_at, "'deadman' has a 'timeout' and a 'value'",
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
  if (!is_readable(point))
    for (const std::string_view key : {"rate", "publish", "max_interval", "latch"})
      refuse(key, fmt::format("'{}' is for a point that is read, this one has 'access: write'", key),
             "remove it");
  if (!is_readable(point) && point.host.verify_write)
    refuse("verify_write", "'verify_write' reads the point back, this one has 'access: write'",
           "remove one of the two");
  if (!on_change)
    refuse("max_interval", "'max_interval' is for 'publish: on_change'", "add it, or remove this");
  if (is_writable(point.table) && !is_writable(point))
    for (const std::string_view key : {"write_function", "verify_write", "write_queue", "deadman"})
      refuse(key, fmt::format("'{}' is for a point that is written, this one has 'access: read'", key),
             "remove it");
  return found;
}

void check_deadband(const Reader& reader, const Point& point, Context& context) {
  const Entry* deadband = holds_bits(point.table) ? nullptr : reader.find("deadband");
  if (deadband == nullptr) return;
  if (!codec::is_scalable(point.format.type))
    context.problems.error(deadband->key_at,
                           fmt::format("'deadband' does not apply to {}", to_string(point.format.type)),
                           "remove it; it is for numbers: SINT to ULINT, REAL and LREAL");
  else if (point.host.publish != HostOptions::Publish::on_change)
    context.problems.error(deadband->key_at, "'deadband' is for 'publish: on_change'",
                           "add it, or remove this");
}

/// Function codes 5 and 6 write one address.
void check_write_function(const Reader& reader, Point& point, Context& context) {
  if (point.host.write_function != WriteFunction::single || fits_one_request(point)) return;
  if (const Entry* own = reader.find("write_function"))
    context.problems.error(own->at,
                           fmt::format("{} has {} addresses, function codes 5 and 6 write one",
                                       shown(point.name), range(point).count()),
                           "write 'multiple', or remove it");
  point.host.write_function = WriteFunction::automatic;
}

}  // namespace

HostDefaults read_host_defaults(const Reader& top, Context& context) {
  HostDefaults defaults;
  const Entry* entry = top.find("defaults");
  if (entry == nullptr) return defaults;
  if (entry->kind != Entry::Kind::map) {
    top.wrong("defaults", "a map of what the host does with points");
    return defaults;
  }
  const Reader reader(*entry, Section::defaults, context);
  read_publishing(reader, defaults.options);
  reader.number("deadband", defaults.options.deadband);
  read_writing(reader, defaults.options);
  defaults.deadman = reader.find("deadman");
  return defaults;
}

void read_host_options(const Reader& reader, const HostDefaults& defaults, DraftPoint& draft,
                       Context& context) {
  Point& point = draft.point;
  HostOptions& options = point.host;
  options = defaults.options;
  const bool bits = holds_bits(point.table);
  read_publishing(reader, options);
  if (!bits) reader.number("deadband", options.deadband);
  const bool number = !bits && codec::is_scalable(point.format.type);
  if (!number) options.deadband = 0;
  if (is_writable(point.table)) read_writing(reader, options);
  for (Complaint& wrong : complaints(reader, point))
    context.problems.error(reader.find(wrong.key)->key_at, std::move(wrong.what), std::move(wrong.remedy));
  if (!draft.placed) return;
  check_deadband(reader, point, context);
  if (!is_writable(point)) {
    const HostOptions usual;
    options.write_function = usual.write_function;
    options.write_queue = usual.write_queue;
    options.verify_write = usual.verify_write;
    return;
  }
  if (!is_readable(point)) options.verify_write = false;
  check_write_function(reader, point, context);
  const Entry* own = reader.find("deadman");
  if (const Entry* deadman = own != nullptr ? own : defaults.deadman)
    options.deadman = read_deadman(*deadman, point, context);
}

}  // namespace coupler::loader
