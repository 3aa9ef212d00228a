// SPDX-License-Identifier: Apache-2.0
// What becomes of a writer's values when the connection ends, and which are written again over the next one.
#include <utility>

#include <fmt/format.h>

#include "coupler/host/core/deadmen.hpp"
#include "coupler/host/core/writer.hpp"

namespace coupler::host {
namespace {

using Outcome = WriteResult::Outcome;

/// As deadman_retry, for a value that ended two connections in a row.
constexpr auto suspect_retry = std::chrono::seconds(10);

/// Returns what happens to a write that waits while there is no connection.
std::string_view unconnected_text(const Map& map, const Write& write) {
  const Point& point = map.points[write.point];
  if (write.until != Time::max() || tool_with_output(map, point.name) != nullptr) return "not connected";
  if (is_pulsed(point)) return "not connected; a pulse is not written when the device is back";
  return "not connected; with 'on_reconnect: restore' in the map it would be written when the device is back";
}

}  // namespace

Result<> Writer::reconnected() {
  merges_ = true;
  fire_deadmen();
  if (auto restored = restore(); !restored) return restored;
  safe_calls_.open();
  return {};
}

/// Points for which a newer value waits are owed until that is written.
Result<> Writer::restore() {
  forget_owed();
  std::vector<Write> values;
  for (const auto& [point, write] : last_written_)
    if (queue_.is_pending(point))
      owed_.insert(point);
    else
      values.push_back(write);
  return restore(values);
}

/// Call it when a write was settled or withdrawn. A deadman's value was meant to end the one to restore.
void Writer::note_owed(const Write& write, bool is_written) {
  if (owed_.count(write.point) == 0) return;
  if (is_written || write.of_deadman)
    owed_.erase(write.point);
  else
    owes_ = true;
}

void Writer::forget_owed() {
  owed_.clear();
  owes_ = false;
}

/// Points for which yet another value waits stay owed.
std::vector<Write> Writer::take_owed() {
  std::vector<Write> values;
  if (!std::exchange(owes_, false)) return values;
  for (auto point = owed_.begin(); point != owed_.end();) {
    if (queue_.is_pending(*point)) {
      ++point;
      continue;
    }
    const auto last = last_written_.find(*point);
    if (last != last_written_.end()) values.push_back(last->second);
    point = owed_.erase(point);
  }
  return values;
}

/// Writes that ended a connection go last, each by itself.
Result<> Writer::restore(const std::vector<Write>& all) {
  std::vector<std::vector<Write>> requests(1);
  for (const Write& write : all)
    if (suspects_.count(write.point) > 0)
      requests.push_back({write});
    else
      requests.front().push_back(write);
  std::size_t restored = 0;
  for (const std::vector<Write>& values : requests) {
    std::vector<Write> broken;
    const auto rejected = write_values(values, map_, link_, &broken);
    if (!rejected) {
      suspect(broken, rejected.error());
      return tl::make_unexpected(rejected.error());
    }
    for (const Write& write : values) suspects_.erase(write.point);
    for (const auto& [point, reply] : *rejected)
      sink_.on_report(Level::warning,
                      fmt::format("{} was not restored: {}", name(point), to_string(Error(reply))));
    restored += values.size() - rejected->size();
  }
  if (restored > 0) sink_.on_report(Level::info, fmt::format("{} outputs were restored", restored));
  return {};
}

/// When a deadman value that failed is written again: at once when the device is back, but not as long as it
/// ends each connection.
Time Writer::deadman_due(std::uint32_t point, bool is_away) const {
  if (!is_away) return clock_.now() + deadman_retry;
  return suspects_.count(point) > 0 ? clock_.now() + suspect_retry : Time();
}

/// A device that has gone cannot answer either; one that answers other requests, before and after, can.
void Writer::suspect(const std::vector<Write>& writes, const Error& why) {
  if (!is_no_reply(why) || is_closed(why)) return;
  for (const Write& write : writes) {
    if (suspects_.insert(write.point).second || last_written_.erase(write.point) == 0) continue;
    suspects_.erase(write.point);
    sink_.on_report(
        Level::error,
        fmt::format("{} is not restored: the device ends the connection each time it is written ({}), and "
                    "may or may not have carried that out; write it again, and check the device",
                    name(write.point), to_string(why)));
  }
}

void Writer::disconnected(const Error& why) {
  is_sent_ = false;
  send_error_.reset();
  forget_owed();
  safe_calls_.close(to_string(why));
  const Result<> lost = tl::make_unexpected(why);
  finish_done(lost);  // what an exception has left there
  clear_done();
  std::swap(batch_, done_);
  finish_done(lost);
  suspect(done_.writes(), why);
  clear_done();
  while (const auto write = queue_.take()) drop(*write);
}

void Writer::drop_all() {
  while (const auto write = queue_.take()) {
    queue_.settled(write->point);
    tell(*write, {Outcome::dropped, std::nullopt, "the driver ends"});
  }
}

void Writer::remember(const Write& write) {
  if (!restores(write)) return;
  Write& value = last_written_[write.point];
  value = write;
  value.listener = nullptr;
  value.ordered = value.of_schedule = false;
}

void Writer::drop(const Write& write) {
  const bool keeps = restores(write) && !write.of_schedule;  // that has a time of its own
  if (write.of_deadman) deadmen_.retry(write.point, Time());
  queue_.settled(write.point);
  try {
    if (keeps) remember(write);
  } catch (...) {  // there is no memory for it
    tell(write, {Outcome::dropped, std::nullopt, "not connected"});
    throw;
  }
  const WriteResult result = {keeps ? Outcome::kept : Outcome::dropped, std::nullopt,
                              unconnected_text(map_, write)};
  tell(write, result);
  if (keeps || dropped_++ > 0) return;
  sink_.on_report(Level::warning,
                  fmt::format("write to {}: {}. Further writes are dropped silently until the device is back",
                              name(write.point), to_string(result)));
}

}  // namespace coupler::host
