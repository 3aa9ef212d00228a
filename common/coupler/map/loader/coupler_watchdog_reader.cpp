// SPDX-License-Identifier: Apache-2.0
#include "coupler/map/loader/map_keys.hpp"

#include <algorithm>
#include <set>
#include <utility>

#include <fmt/format.h>

#include "coupler/map/loader/preset_watchdog.hpp"

namespace coupler::loader {
namespace {

using Write = WatchdogSequences::Write;

/// The driver feeds so often within a timeout: one request may come late, or be lost.
constexpr int feeds_in_a_timeout = 3;

/// One map's `watchdog` with one preset's.
class Resolver {
 public:
  Resolver(const Entry& entry, const Preset& preset, const Watchdog& wanted, Context& context)
      : entry_(entry), preset_(preset), known_(preset.watchdog), wanted_(wanted), context_(context) {}

  WatchdogSequences resolve(std::optional<std::uint16_t> heartbeat, const DraftPoints& points) {
    heartbeat_ = heartbeat;
    if (wanted_.fed_by == Watchdog::FedBy::write)
      error("fed_by", fmt::format("the driver feeds the watchdog of a {} as long as it runs", preset_.name),
            "remove 'fed_by', and give outputs whose commands must not fall silent a 'deadman'");
    if (wanted_.recovery == Watchdog::Recovery::manual && known_.reset.empty())
      error("recovery", fmt::format("a {} has nothing to be reset", preset_.name), "remove 'recovery'");
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

  Span<const Write> keep(const std::vector<PresetWatchdog::Write>& sequence, const DraftPoints& points) {
    std::vector<Write> writes;
    for (const PresetWatchdog::Write& write : sequence) {
      writes.push_back(resolved(write));
      check_free(writes.back(), points);
    }
    return context_.map.keep(writes);
  }

  Write resolved(const PresetWatchdog::Write& known) {
    Write write = known.write;
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
  void check_free(const Write& write, const DraftPoints& points) {
    for (const DraftPoint& draft : points) {
      const Point& point = draft.point;
      if (!draft.placed || !is_writable(point) || point.table != write.table ||
          !range(point).contains(modbus::Range::of(write.address, 1)) || !told_.insert(&draft).second)
        continue;
      context_.problems.error(draft.address_at,
                              fmt::format("{} is where the driver itself serves the watchdog (line {})",
                                          shown(point.name), entry_.key_at.line),
                              "give the point 'access: read', or remove 'watchdog'");
    }
  }

  const Entry& entry_;
  const Preset& preset_;
  const PresetWatchdog& known_;
  Watchdog wanted_;
  Context& context_;
  std::optional<std::uint16_t> heartbeat_;
  std::set<const DraftPoint*> told_;  ///< that they are in the way
};

bool needs_heartbeat(const PresetWatchdog& watchdog) {
  return std::any_of(watchdog.feed.begin(), watchdog.feed.end(),
                     [](const PresetWatchdog::Write& write) { return write.at_heartbeat; });
}

void refuse_heartbeat(const Entry& heartbeat, const std::optional<Preset>& preset, Context& context) {
  if (preset)
    context.problems.error(
        heartbeat.key_at,
        fmt::format("a {} has a watchdog of its own and needs no 'heartbeat'", preset->name),
        "remove 'heartbeat'");
  else
    context.problems.error(heartbeat.key_at, "'heartbeat' is for a PLC; a node has a watchdog of its own",
                           "remove 'heartbeat', or add 'preset: plc' at the top");
}

std::optional<std::uint16_t> read_heartbeat(const Entry& heartbeat, Addressing addressing, Context& context) {
  const bool is_scalar = heartbeat.kind == Entry::Kind::scalar;
  const auto address = parse_address(is_scalar ? heartbeat.text : "", Table::holding_registers, addressing);
  if (address) return *address;
  context.problems.error(heartbeat.at, address.error().what, address.error().remedy);
  return std::nullopt;
}

}  // namespace

void read_coupler_watchdog(const Reader& top, const std::optional<Preset>& preset, const DraftPoints& points,
                           Addressing addressing, Map& head, Context& context) {
  const Entry* entry = top.find("watchdog");
  if (entry == nullptr) return;
  const Entry* heartbeat = child(*entry, "heartbeat");
  const bool needed = preset && needs_heartbeat(preset->watchdog);
  if (!preset && top.has("preset")) return;  // told already
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
  if (!wanted.present()) return;  // told already
  const auto at = needed ? read_heartbeat(*heartbeat, addressing, context) : std::nullopt;
  if (needed && !at) return;
  head.coupler_watchdog = Resolver(*entry, *preset, wanted, context).resolve(at, points);
}

}  // namespace coupler::loader
