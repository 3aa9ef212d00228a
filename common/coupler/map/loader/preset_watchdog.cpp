// SPDX-License-Identifier: Apache-2.0
#include "coupler/map/loader/preset.hpp"

#include <algorithm>
#include <set>
#include <utility>

#include <fmt/format.h>

#include "coupler/map/loader/map_reader.hpp"
#include "coupler/map/loader/scalar.hpp"

namespace coupler::loader {
namespace {

bool parse_place(const Entry& entry, PresetWatchdog::Write& write) {
  const Entry* coil = child(entry, "coil");
  const Entry* place = coil != nullptr ? coil : child(entry, "holding_register");
  if (place == nullptr) return false;
  write.write.table = coil != nullptr ? Table::coils : Table::holding_registers;
  write.at_heartbeat = place->text == "heartbeat";
  const auto address = word(*place);
  write.write.address = address.value_or(0);
  return address || write.at_heartbeat;
}

bool parse_value(const Entry& entry, PresetWatchdog::Write& write) {
  const Entry* value = child(entry, "value");
  if (value == nullptr) return false;
  if (value->text == "timeout") {
    const Entry* unit = child(entry, "unit");
    write.unit = (unit != nullptr ? parse_duration(unit->text) : std::nullopt).value_or(write.unit);
    return write.unit.count() > 0;
  }
  const auto given = word(*value);
  write.write.value = given.value_or(0);
  return given.has_value();
}

/// A list of writes. False if one of them makes no sense.
bool parse_sequence(const Entry& list, std::vector<PresetWatchdog::Write>& sequence) {
  for (const Entry& element : list.children) {
    PresetWatchdog::Write& write = sequence.emplace_back();
    if (!parse_place(element, write) || !parse_value(element, write)) return false;
    if (const Entry* flag = child(element, "if_different"))
      write.write.if_different = parse_boolean(flag->text).value_or(false);
  }
  return list.kind == Entry::Kind::list;
}

bool parse_feed(const Entry& entry, std::vector<PresetWatchdog::Write>& feed) {
  const Entry* values = child(entry, "values");
  PresetWatchdog::Write write;
  if (values == nullptr || !parse_place(entry, write)) return false;
  for (const Entry& element : values->children) {
    const auto value = word(element);
    if (!value) return false;
    write.write.value = *value;
    feed.push_back(write);
  }
  return !feed.empty();
}

bool parse_expired(const Entry& entry, PresetWatchdog& watchdog) {
  if (const auto code = word(entry, "exception")) {
    watchdog.refusal = static_cast<modbus::Exception>(*code);
    return *code > 0 && *code < 0x100;
  }
  PresetWatchdog::Write alarm;
  if (!parse_place(entry, alarm) || !parse_value(entry, alarm)) return false;
  watchdog.alarm = alarm.write;
  return !alarm.at_heartbeat && alarm.unit.count() == 0;
}

bool parse_part(const Entry& part, PresetWatchdog& watchdog) {
  if (part.key == "arm") return parse_sequence(part, watchdog.arm);
  if (part.key == "reset") return parse_sequence(part, watchdog.reset);
  if (part.key == "feed") return parse_feed(part, watchdog.feed);
  return part.key == "expired" && parse_expired(part, watchdog);
}

/// How often the driver feeds within a timeout: a request may come late or be lost.
constexpr int feeds_in_a_timeout = 3;

/// Joins the `watchdog` of a map and that of its preset.
class Resolver {
 public:
  Resolver(const Entry& entry, const Preset& preset, const Watchdog& wanted, const Context& context)
      : entry_(entry), preset_(preset), known_(preset.watchdog), wanted_(wanted), context_(context) {}

  WatchdogSequences resolve(std::optional<std::uint16_t> heartbeat, const DraftPoints& points) {
    heartbeat_ = heartbeat;
    if (wanted_.fed_by == Watchdog::FedBy::write)
      error("fed_by", fmt::format("the driver feeds the watchdog of a {} as long as it runs", preset_.name),
            "remove 'fed_by'; use 'deadman' for outputs that must become safe when no commands come");
    if (wanted_.recovery == Watchdog::Recovery::manual && known_.reset.empty())
      error("recovery", fmt::format("the watchdog of a {} needs no reset", preset_.name),
            "remove 'recovery'");
    WatchdogSequences result;
    result.timeout = wanted_.timeout;
    result.recovery = wanted_.recovery;
    result.arm = keep(known_.arm, points);
    result.feed = keep(known_.feed, points);
    result.feed_every = std::max(wanted_.timeout / feeds_in_a_timeout, std::chrono::milliseconds(1));
    result.reset = keep(known_.reset, points);
    result.refusal = known_.refusal;
    result.alarm = known_.alarm;
    return result;
  }

 private:
  void error(std::string_view key, std::string what, std::string remedy) {
    const Entry* at = child(entry_, key);
    context_.problems.error(at != nullptr ? at->at : entry_.key_at, std::move(what), std::move(remedy));
  }

  Span<const WatchdogSequences::Write> keep(const std::vector<PresetWatchdog::Write>& sequence,
                                            const DraftPoints& points) {
    std::vector<WatchdogSequences::Write> writes;
    for (const PresetWatchdog::Write& write : sequence) {
      writes.push_back(resolved(write));
      check_free(writes.back(), points);
    }
    return context_.map.keep(writes);
  }

  WatchdogSequences::Write resolved(const PresetWatchdog::Write& known) {
    WatchdogSequences::Write write = known.write;
    if (known.at_heartbeat) write.address = heartbeat_.value_or(0);
    if (known.unit.count() > 0) write.value = counted(known.unit);
    return write;
  }

  std::uint16_t counted(std::chrono::microseconds unit) {
    const auto count = wanted_.timeout / unit;
    const auto ms = std::chrono::duration_cast<std::chrono::milliseconds>(unit).count();
    if (wanted_.timeout % unit != unit.zero())
      error("timeout",
            fmt::format("the watchdog of a {} counts in steps of {} ms, and {} ms is not a multiple of that",
                        preset_.name, ms, wanted_.timeout.count()),
            fmt::format("write 'timeout: {}ms'", (count + 1) * ms));
    else if (count > 0xFFFF)
      error("timeout", fmt::format("the watchdog of a {} counts up to {} ms", preset_.name, 0xFFFF * ms),
            "write a shorter 'timeout'");
    return static_cast<std::uint16_t>(count);
  }

  /// No point of the map may write where the driver does.
  void check_free(const WatchdogSequences::Write& write, const DraftPoints& points) {
    for (const DraftPoint& draft : points) {
      const Point& point = draft.point;
      if (!draft.placed || !is_writable(point) || point.table != write.table ||
          !range(point).contains(modbus::Range::of(write.address, 1)) || !reported_.insert(&draft).second)
        continue;
      context_.problems.error(
          draft.address_at,
          fmt::format("{} is at an address that the driver writes for the watchdog (line {})",
                      shown(point.name), entry_.key_at.line),
          "give the point 'access: read', or remove 'watchdog'");
    }
  }

  const Entry& entry_;
  const Preset& preset_;
  const PresetWatchdog& known_;
  Watchdog wanted_;
  const Context& context_;
  std::optional<std::uint16_t> heartbeat_;
  std::set<const DraftPoint*> reported_;
};

bool needs_heartbeat(const PresetWatchdog& watchdog) {
  return std::any_of(watchdog.feed.begin(), watchdog.feed.end(),
                     [](const PresetWatchdog::Write& write) { return write.at_heartbeat; });
}

void refuse_heartbeat(const Entry& heartbeat, const std::optional<Preset>& preset, const Context& context) {
  if (preset)
    context.problems.error(
        heartbeat.key_at,
        fmt::format("a {} has a watchdog of its own and needs no 'heartbeat'", preset->name),
        "remove 'heartbeat'");
  else
    context.problems.error(heartbeat.key_at, "'heartbeat' is for a PLC; a node has a watchdog of its own",
                           "remove 'heartbeat', or add 'preset: plc' at the top");
}

std::optional<std::uint16_t> read_heartbeat(const Entry& heartbeat, Addressing addressing,
                                            const Context& context) {
  const bool is_scalar = heartbeat.kind == Entry::Kind::scalar;
  const auto address = parse_address(is_scalar ? heartbeat.text : "", Table::holding_registers, addressing);
  if (address) return *address;
  context.problems.error(heartbeat.at, address.error().what, address.error().remedy);
  return std::nullopt;
}

}  // namespace

tl::expected<PresetWatchdog, Position> parse_preset_watchdog(const Entry& entry) {
  PresetWatchdog watchdog;
  watchdog.none = entry.text == "none";
  if (entry.kind != Entry::Kind::map && !watchdog.none) return tl::make_unexpected(entry.at);
  for (const Entry& part : entry.children)
    if (!parse_part(part, watchdog)) return tl::make_unexpected(part.key_at);
  return watchdog;
}

std::optional<std::uint16_t> word(const Entry& entry) {
  const auto value = parse_unsigned(entry.text);
  if (!value || *value > 0xFFFF) return std::nullopt;
  return static_cast<std::uint16_t>(*value);
}

std::optional<std::uint16_t> word(const Entry& entry, std::string_view key) {
  const Entry* found = child(entry, key);
  return found != nullptr ? word(*found) : std::nullopt;
}

void read_coupler_watchdog(const Reader& top, const std::optional<Preset>& preset, const DraftPoints& points,
                           Addressing addressing, Map& head, const Context& context) {
  const Entry* entry = top.find("watchdog");
  if (entry == nullptr) return;
  const Entry* heartbeat = child(*entry, "heartbeat");
  if (!preset && top.has("preset")) return;  // already a problem
  if (preset && preset->watchdog.none) {
    context.problems.error(
        entry->key_at, fmt::format("a {} has no watchdog", preset->name),
        "remove 'watchdog'; use 'deadman' for outputs that must become safe when no commands come");
    return;
  }
  const bool needed = preset && needs_heartbeat(preset->watchdog);
  if (heartbeat != nullptr && !needed) refuse_heartbeat(*heartbeat, preset, context);
  if (!preset) return;
  const Watchdog wanted = std::exchange(head.service.watchdog, {});
  if (needed && heartbeat == nullptr) {
    context.problems.error(entry->key_at,
                           fmt::format("a {} has no watchdog unless its program has one", preset->name),
                           "name the holding register that its program watches, as in "
                           "'watchdog: {timeout: 500ms, heartbeat: 100}', or remove 'watchdog'");
    return;
  }
  if (!wanted.present()) return;  // already a problem
  const auto at = needed ? read_heartbeat(*heartbeat, addressing, context) : std::nullopt;
  if (needed && !at) return;
  head.coupler_watchdog = Resolver(*entry, *preset, wanted, context).resolve(at, points);
}

}  // namespace coupler::loader
