// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/cli/device_reader.hpp"

#include <algorithm>
#include <iterator>
#include <utility>

#include <fmt/format.h>

#include "coupler/host/core/poll_cycle.hpp"
#include "coupler/map/node_address.hpp"
#include "coupler/plan/explain.hpp"
#include "coupler/plan/read_span.hpp"

namespace coupler::cli {
namespace {

using host::Identity;
using host::Result;
using modbus::Exception;
using plan::ReadSpan;
using State = Reading::State;

/// Devices answer a range that they do not have, or that is too long for them, with either of these; a node
/// one that may not be read with 01.
constexpr bool is_rejection(Exception code, bool is_node) {
  return code == Exception::illegal_data_address || code == Exception::illegal_data_value ||
         (is_node && code == Exception::illegal_function);
}

/// Requests without a reply that are put off until another one has one. No more: a device that is silent
/// would be waited for that many timeouts.
constexpr std::size_t most_tried_later = 1;

/// The answer can be another one for a part of the range: one line that fails is answered for all.
constexpr bool is_of_the_range(Exception code, bool is_node) {
  return (is_node || code != Exception::illegal_function) && code != Exception::acknowledge &&
         code != Exception::server_device_busy;
}

/// Smaller requests for the points, which are some of those that `span` reads.
plan::Split split_or_narrow(ReadSpan span, const Map& map) {
  if (span.points.empty()) return {};
  const auto range_of = [&map](std::uint32_t point) { return read_range(map.points[point]); };
  const std::uint32_t start = range_of(span.points.front()).start();
  std::uint32_t end = start;
  for (const std::uint32_t point : span.points) end = std::max(end, range_of(point).end());
  const modbus::Range narrow = modbus::Range::of(start, end - start);
  if (narrow == span.range) return plan::split(span, map);
  span.range = narrow;
  return {{std::move(span)}, {}};
}

/// The meaning of a device's identity for reading it.
struct IdentityFindings {
  struct LeftOut {
    std::uint32_t point;  ///< index into Map::points
    std::string why;
  };
  std::vector<std::string> notes;  ///< for people
  std::vector<LeftOut> left_out;   ///< points whose places mean something else in the device's own map
};

std::string difference_note(const Map& map, const Identity& identity) {
  if (identity.points.empty()) return difference_text(map, identity);
  return difference_text(map, identity) +
         "\nOnly points that are the same are read. To read by the device's own map, give " +
         node_address_text(map.connection) + " instead of this one";
}

IdentityFindings findings(const Map& map, const Identity& identity) {
  if (identity.verdict == Identity::Verdict::superset) return {{host::superset_text}, {}};
  if (identity.verdict != Identity::Verdict::different) return {};
  IdentityFindings found{{difference_note(map, identity)}, {}};
  for (const Difference& difference : identity.points) {
    if (!is_breaking(difference.kind)) continue;
    const bool missing = difference.kind == Difference::Kind::missing;
    const auto point = static_cast<std::uint32_t>(find(map, difference.point) - map.points.begin());
    found.left_out.push_back(
        {point, missing ? "not in the device's map" : "different in the device's map: " + difference.what});
  }
  if (identity.points.empty())
    for (std::uint32_t point = 0; point < map.points.size(); ++point)
      found.left_out.push_back({point, "the device's map cannot be compared"});
  return found;
}

}  // namespace

DeviceReader::DeviceReader(const Map& map, const std::vector<bool>& chosen, host::Link& link,
                           host::MapLoader load, ChangeWatch::Use use)
    : map_(map),
      load_(std::move(load)),
      planner_(map),
      link_(link),
      clock_(link.clock()),
      changes_(map_, link_, statistics_, std::move(use), [this](std::string text) { note(std::move(text)); }),
      chosen_(chosen),
      place_(map.points.size()) {
  for (std::uint32_t point = 0; point < map.points.size(); ++point) {
    if (!chosen[point]) continue;
    place_[point] = blank_.readings.size();
    Reading& reading = blank_.readings.emplace_back(Reading{point});
    if (const auto reason = plan::why_not_read(map, map.points[point])) {
      reading.state = State::not_asked;
      reading.why = plan::words_of(*reason);
    }
  }
  no_reply_.resize(blank_.readings.size());
}

Snapshot DeviceReader::look() {
  now_ = blank_;
  const Result<> done = connected_ ? Result<>{} : connect();
  if (done) now_ = known_;
  const Result<> read = done ? read_all() : done;
  if (!read) lost(read.error());
  now_.at = std::chrono::system_clock::now();
  return now_;
}

std::optional<Snapshot> DeviceReader::wait_until(host::Time time) {
  if (!connected_ || !changes_.is_active()) {
    clock_.sleep_until(time);
    return std::nullopt;
  }
  const Result<> waited = changes_.wait_until(time);
  if (waited) return std::nullopt;
  now_ = known_;
  lost(waited.error());
  now_.at = std::chrono::system_clock::now();
  return now_;
}

void DeviceReader::lost(const host::Error& error) {
  now_.error = error;
  for (Reading& reading : now_.readings)
    if (reading.state == State::failed && reading.why.empty()) reading.why = to_string(error);
  changes_.lost();
  link_.close();
  connected_ = false;
}

Result<> DeviceReader::connect() {
  known_ = blank_;
  if (auto opened = link_.connect(); !opened) return opened;
  if (map_.verify != Verify::off && !map_.connection.is_broadcast())
    if (auto identified = identify(); !identified) return identified;
  is_node_ = known_.identity.value_or(Identity::Verdict::foreign) != Identity::Verdict::foreign;
  if (auto started = changes_.start(is_node_); !started) return started;
  plan();
  connected_ = true;
  return {};
}

Result<> DeviceReader::identify() {
  const std::uint64_t replies = link_.replies();
  const auto identity = check_identity(link_, map_, load_);
  if (identity) {
    judge(*identity);
    return {};
  }
  if (link_.replies() != replies) return tl::make_unexpected(identity.error());
  // Some couplers ignore addresses that they do not have. A late answer must not be taken for another.
  known_.notes.push_back(fmt::format(
      "the device does not answer the request for its identity ({}): it is read as a foreign coupler",
      to_string(identity.error())));
  link_.close();
  return link_.connect();
}

void DeviceReader::judge(const Identity& identity) {
  known_.identity = identity.verdict;
  IdentityFindings found = findings(map_, identity);
  known_.notes = std::move(found.notes);
  for (auto& [point, why] : found.left_out) {
    if (!chosen_[point]) continue;
    Reading& reading = known_.readings[place_[point]];
    if (reading.state == State::failed) reading.why = std::move(why);
  }
}

void DeviceReader::plan() {
  spans_.clear();
  std::vector<Unreadable> left_out;  // the device may have anything there
  for (const Reading& reading : known_.readings) {
    const Point& point = map_.points[reading.point];
    if (reading.state == State::failed && !reading.why.empty())
      left_out.push_back({point.table, read_range(point)});
  }
  for (const plan::RateGroup& group : planner_.groups()) {
    std::vector<std::uint32_t> points;
    for (const std::uint32_t point : group.points)
      if (chosen_[point] && known_.readings[place_[point]].why.empty()) points.push_back(point);
    auto spans = planner_.plan(points, left_out);
    spans_.insert(spans_.end(), std::make_move_iterator(spans.begin()), std::make_move_iterator(spans.end()));
  }
}

Result<> DeviceReader::read_all() {
  std::vector<ReadSpan> next;
  std::vector<ReadSpan> later;
  for (const ReadSpan& span : spans_) {
    Result<> answer = ask(span, next);
    if (answer) continue;
    // Perhaps it is that one only: others first.
    if (answered_ || !is_no_reply(answer.error()) || later.size() == most_tried_later) return answer;
    later.push_back(span);
    if (auto again = connect_again(); !again) return again;
  }
  for (const ReadSpan& span : later)
    if (auto answer = ask(span, next); !answer) return answer;
  spans_ = std::move(next);
  now_.notes = known_.notes;
  return {};
}

/// Appends to `next` the requests to make in its place at the next look.
Result<> DeviceReader::ask(const ReadSpan& span, std::vector<ReadSpan>& next) {
  if (aside_.rests(span, clock_.now())) {
    for (const std::uint32_t point : span.points) reading(point).why = no_reply_[place_[point]];
    next.push_back(span);
    return {};
  }
  return take(span, link_.read(span.table, span.range, registers_.data()), next);
}

Result<> DeviceReader::take(const ReadSpan& span, Result<> answer, std::vector<ReadSpan>& next) {
  if (answer) {
    keep(span);
    answered_ = {span.table, span.range};
    aside_.answered(span);
    next.push_back(span);
    return answer;
  }
  const host::ExceptionReply* exception = exception_in(answer.error());
  if (is_no_reply(answer.error())) return without(span, answer.error(), next);
  if (exception == nullptr || is_unit_away(answer.error())) return answer;
  if (is_of_the_range(exception->code, is_node_)) return in_parts(span, refusal(exception->code), next);
  fail(span, refusal(exception->code));
  next.push_back(span);
  return {};
}

Result<> DeviceReader::connect_again() {
  link_.close();
  return link_.connect();
}

/// A late answer must not be taken for another: the connection is made anew. If another request is answered
/// then, as before, this one is to blame.
Result<> DeviceReader::without(const ReadSpan& span, const host::Error& error, std::vector<ReadSpan>& next) {
  if (!answered_ || is_node_) return tl::make_unexpected(error);
  if (auto again = connect_again(); !again) return again;
  if (is_closed(error)) {  // by a device that does so after some requests, or for another client, it is
                           // answered now
    Result<> alone = link_.read(span.table, span.range, registers_.data());
    if (alone || !is_no_reply(alone.error())) return take(span, std::move(alone), next);
    if (auto again = connect_again(); !again) return again;
  }
  if (auto other = link_.ask(*answered_); !other) return other;
  return in_parts(span, {{}, to_string(error) + ", though others have one; asked again now and then"}, next);
}

Result<> DeviceReader::in_parts(const ReadSpan& span, const Refusal& refusal, std::vector<ReadSpan>& next) {
  ReadSpan whole{span.table, span.range, {}};  // the points that no smaller request reads
  ReadSpan rest = whole;
  for (const std::uint32_t point : span.points)
    (read_range(map_.points[point]) == span.range ? whole : rest).points.push_back(point);
  fail(whole, refusal);
  const host::Time now = clock_.now();
  if (!refusal.code && !whole.points.empty() && !aside_.failed_again(whole, now)) aside_.add(whole, now);
  plan::Split split = split_or_narrow(rest, map_);
  std::vector<ReadSpan> parts;
  for (const ReadSpan& piece : split.pieces)
    if (auto answer = ask(piece, parts); !answer) return answer;
  if (refusal.code && !is_rejection(*refusal.code, is_node_)) {  // it may pass: the whole is asked for again
    next.push_back(span);
    return {};
  }
  const bool parts_are_good =
      parts.size() == split.pieces.size() &&
      std::all_of(span.points.begin(), span.points.end(),
                  [this](std::uint32_t point) { return reading(point).state == State::good; });
  if (parts_are_good) {
    const bool hole = split.hole && !planner_.has_points(span.table, *split.hole);
    note(to_string(host::RejectedRange{span.table, hole ? *split.hole : span.range, hole}));
  }
  if (!whole.points.empty()) next.push_back(std::move(whole));
  next.insert(next.end(), std::make_move_iterator(parts.begin()), std::make_move_iterator(parts.end()));
  return {};
}

void DeviceReader::note(std::string text) {
  std::vector<std::string>& notes = known_.notes;
  if (std::find(notes.begin(), notes.end(), text) == notes.end()) notes.push_back(std::move(text));
}

void DeviceReader::keep(const ReadSpan& span) {
  for (const std::uint32_t point : span.points) {
    const modbus::Range range = read_range(map_.points[point]);
    const auto* const from = registers_.data() + (range.start() - span.range.start());
    Reading& good = reading(point);
    good.state = State::good;
    good.registers.assign(from, from + range.count());
  }
}

DeviceReader::Refusal DeviceReader::refusal(Exception code) const {
  const bool is_right = is_node_ && code == Exception::illegal_function;  // a node knows how to read
  return {code, host::to_string(host::Error(host::ExceptionReply{code})) +
                    (is_right ? ": this client has no right to read it" : "")};
}

void DeviceReader::fail(const ReadSpan& span, const Refusal& refusal) {
  for (const std::uint32_t point : span.points) {
    Reading& failed = reading(point);
    failed.exception = refusal.code;
    failed.why = refusal.why;
    if (!refusal.code) no_reply_[place_[point]] = refusal.why;
  }
}

}  // namespace coupler::cli
