// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/core/poller.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "coupler/map/functions.hpp"

namespace coupler::host {

Poller::Poller(const Map& map, Link& link, Writer& writer, DeviceStatistics& statistics, ValueTable& values,
               Sink& sink)
    : map_(map),
      link_(link),
      clock_(link.clock()),
      writer_(writer),
      statistics_(statistics),
      values_(values),
      sink_(sink),
      cycle_(map),
      told_(map_, cycle_, writer, values, sink) {}

void Poller::start(bool is_node, bool told) {
  is_node_ = is_node;
  values_.connected();
  cycle_.start(clock_.now());
  told_.start(told);
}

Result<> Poller::step(Time until) {
  if (!has_request(clock_.now()) || link_.await_turn(until) != Link::Turn::read) return {};
  const ReadSpan& span = cycle_.current();
  if (Result<> answer = link_.read(span.table, span.range, read_.data()); !answer) {
    const ExceptionReply* exception = exception_in(answer.error());
    if (exception == nullptr) return answer;
    if (is_unit_away(answer.error())) {
      values_.exception(span.points, exception->code);
      return answer;  // the sink learns that the device is lost
    }
    on_exception(exception->code);
  } else {
    publish(span);
    answered_ = {span.table, span.range};
    const std::string name = cycle_.failing() ? describe(span) : std::string();
    if (cycle_.answered(std::nullopt, clock_.now()))
      sink_.on_report(Level::info, name + " can be read again");
  }
  request_ended();
  return {};
}

void Poller::request_ended() {
  report_rejected_ranges();
  const auto cycle_time = cycle_.take_cycle_time();
  if (!cycle_time) return;
  statistics_.cycle_ended(*cycle_time, cycle_.overruns());
  has_ended_cycle_ = true;
}

void Poller::set_aside(const Error& error) {
  ReadSpan left = cycle_.current();
  left.points = cycle_.set_aside(clock_.now());
  if (!left.points.empty()) {
    const std::string why =
        fmt::format("{} to the request for it (FC {}, {}, {} {}{})", to_string(error),
                    static_cast<int>(read_function(left.table)), left.range.start(), left.range.count(),
                    holds_bits(left.table) ? "bit" : "register", left.range.count() == 1 ? "" : "s");
    values_.set_aside(left.points, why);
    sink_.on_no_values(left.points, clock_.now());
    tell_late();
    sink_.on_report(
        Level::warning,
        fmt::format("{} cannot be read: {}, though other requests are answered; it is tried again "
                    "in 10 s, and then less and less often",
                    describe(left), why));
  }
  request_ended();
}

void Poller::publish(const ReadSpan& span) {
  const Span<const std::uint16_t> read(read_.data(), span.range.count());
  const bool hides = writer_.hides_any() || told_.leaves_out_any();
  const ReadSpan& fresh = hides ? without_hidden(span) : span;
  values_.store(fresh, read, told_.read(fresh, read, link_.last_stamp()), link_.last_answer());
  if (hides) values_.good(span.points, link_.last_answer());
  if (values_.can_be_unusable())
    tell_apart(fresh.points);
  else
    sink_.on_values(fresh.points);
  writer_.shown(fresh.points);
}

/// Tells the sink about points that became invalid because the exponents of their scales could not be read.
void Poller::tell_late() {
  if (!values_.late().empty()) sink_.on_no_values(values_.late(), clock_.now());
}

/// Tells the sink which of the points that were read have a value to be used.
void Poller::tell_apart(Span<const std::uint32_t> points) {
  usable_.clear();
  unusable_.clear();
  for (const Span<const std::uint32_t> read : {points, values_.late()})
    for (const std::uint32_t point : read)
      if (!values_.waits(point)) (values_.is_usable(point) ? usable_ : unusable_).push_back(point);
  sink_.on_values(usable_);
  if (!unusable_.empty()) sink_.on_no_values(unusable_, link_.last_answer());
}

const ReadSpan& Poller::without_hidden(const ReadSpan& span) {
  rest_.table = span.table;
  rest_.range = span.range;
  rest_.points.clear();
  const Span<const std::uint16_t> read(read_.data(), span.range.count());
  for (const std::uint32_t point : span.points)
    if (!told_.leave_out(point, span, read) && !writer_.hides(point)) rest_.points.push_back(point);
  return rest_;
}

void Poller::on_exception(modbus::Exception code) {
  const ReadSpan span = cycle_.current();
  const std::string why = to_string(Error(ExceptionReply{code}));
  switch (code) {
    // Devices answer a range that they do not have, or that is too long for them, with either of these.
    case modbus::Exception::illegal_data_address:
    case modbus::Exception::illegal_data_value:
      on_rejection(code, "is not in the device", "it is not read again while this connection lasts");
      return;
    case modbus::Exception::illegal_function:
      if (is_node_)
        return on_rejection(code, "cannot be read: this client has no right to",
                            "it is read again when the device has read its map again");
      statistics_.rejected();
      values_.rejected(span.points, code);
      sink_.on_no_values(span.points, clock_.now());
      tell_late();
      if (cycle_.only_looks()) {
        cycle_.answered(code, clock_.now());
        return;
      }
      cycle_.give_up(clock_.now());
      sink_.on_report(Level::warning,
                      fmt::format("{} cannot be read: {}; it is not read again while this connection "
                                  "lasts",
                                  describe(span), why));
      return;
    default:
      if (cycle_.only_looks() && ask_in_parts(code)) return;
      values_.exception(span.points, code);
      sink_.on_no_values(span.points, clock_.now());
      tell_late();
      if (cycle_.answered(code, clock_.now()))
        sink_.on_report(Level::warning, fmt::format("{} cannot be read now: {}", describe(span), why));
  }
}

/// Replaces the request that failed with smaller ones. Returns false if there are none, or if the device is
/// only busy. If it returns true, only the points that no smaller request reads have failed.
bool Poller::ask_in_parts(modbus::Exception code) {
  if (code == modbus::Exception::acknowledge || code == modbus::Exception::server_device_busy) return false;
  const auto alone = cycle_.failed(clock_.now());
  if (!alone) return false;
  values_.exception(*alone, code);
  sink_.on_no_values(*alone, clock_.now());
  tell_late();
  return true;
}

/// Handles the exception of a request, parts of which may be good.
void Poller::on_rejection(modbus::Exception code, std::string_view what, std::string_view until) {
  statistics_.rejected();
  ReadSpan left = cycle_.current();
  left.points = cycle_.rejected(clock_.now());
  if (left.points.empty()) return;
  values_.rejected(left.points, code);
  sink_.on_no_values(left.points, clock_.now());
  tell_late();
  sink_.on_report(Level::warning, fmt::format("{} {}: {}; {}", describe(left), what,
                                              to_string(Error(ExceptionReply{code})), until));
}

void Poller::report_rejected_ranges() {
  for (const RejectedRange& range : cycle_.take_rejected_ranges())
    sink_.on_note(Level::warning, to_string(range));
}

std::string Poller::describe(const ReadSpan& span) const {
  constexpr std::size_t most = 8;
  std::string names;
  for (std::size_t i = 0; i < std::min(span.points.size(), most); ++i)
    names += fmt::format("{}{}", i == 0 ? "" : ", ", map_.points[span.points[i]].name);
  if (span.points.size() == 1) return names;
  if (span.points.size() > most) names += fmt::format(" and {} more", span.points.size() - most);
  const bool is_one = span.range.count() == 1;
  return fmt::format("{} {} ({})", to_string(span.table),
                     is_one ? std::to_string(span.range.start())
                            : fmt::format("{} to {}", span.range.start(), span.range.last()),
                     names);
}

}  // namespace coupler::host
