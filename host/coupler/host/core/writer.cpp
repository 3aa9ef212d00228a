// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/core/writer.hpp"

#include <fmt/format.h>

#include "coupler/host/core/value_text.hpp"
#include "coupler/map/typed_value.hpp"

namespace coupler::host {
namespace {

using Outcome = WriteResult::Outcome;

constexpr WriteResult no_room = {Outcome::dropped, std::nullopt,
                                 "too many writes are waiting; write less often"};

/// With these the device has carried out nothing of a request and never will. The cause may be how it was put
/// together: a device that takes one value only, or one of several that it does not have.
bool is_wrong(modbus::Exception code) {
  return code == modbus::Exception::illegal_function || code == modbus::Exception::illegal_data_address ||
         code == modbus::Exception::illegal_data_value;
}

/// " idle", for the log. Nothing of an array or a text, which may be long.
std::string deadman_value(const Point& point) {
  if (point.count > 1 || point.format.type == codec::Type::STRING) return {};
  return ' ' + format_value(point.host.deadman.value.data(), point);
}

}  // namespace

Writer::Writer(const Map& map, Link& link, DeviceStatistics& statistics, ValueTable& values, Sink& sink)
    : map_(map),
      link_(link),
      clock_(link.clock()),
      statistics_(statistics),
      values_(values),
      sink_(sink),
      queue_(map),
      deadmen_(map),
      safe_values_(safe_values(map)),
      is_safe_point_(map.points.size()),
      acknowledged_(map.points.size()),
      batch_(map),
      done_(map) {
  for (const Write& write : safe_values_) is_safe_point_[write.point] = true;
  for (std::uint32_t i = 0; i < map.points.size(); ++i)
    if (tool_with_output(map, map.points[i].name) != nullptr) is_safe_point_[i] = true;
}

/// Empty: the point may have this value.
std::string Writer::why_forbidden(const Write& write) const {
  const Point& point = map_.points[write.point];
  const auto forbidden = find_forbidden(point, write.registers.data());
  return forbidden ? fmt::format("{}; send {}", forbidden_text(point, *forbidden), allowed_text(point))
                   : std::string();
}

/// It does not get into the queue: its listener and the log hear so.
void Writer::reject(const Write& write, const WriteResult& result) {
  tell(write, result);
  report(write, result);
}

void Writer::push(const Write& write) {
  if (const std::string why = why_forbidden(write); !why.empty())
    return reject(write, {Outcome::refused, std::nullopt, why});
  const WriteQueue::Pushed pushed = queue_.push(write);
  if (pushed.accepted) deadmen_.fed(write.point, clock_.now());
  if (pushed.superseded) tell(*pushed.superseded, {Outcome::superseded});
  if (!pushed.accepted) reject(write, no_room);
}

void Writer::push_together(Span<const Write> writes) {
  for (const Write& wrong : writes)
    if (const std::string why = why_forbidden(wrong); !why.empty()) {
      reject(wrong, {Outcome::refused, std::nullopt, why});
      const std::string beside =
          fmt::format("the value of {}, which is written together with it, is refused", name(wrong.point));
      for (const Write& other : writes)
        if (&other != &wrong) tell(other, {Outcome::dropped, std::nullopt, beside});
      return;
    }
  const bool accepted = queue_.push_together(writes);
  for (const Write& write : writes) {
    if (accepted)
      deadmen_.fed(write.point, clock_.now());
    else
      reject(write, no_room);
  }
}

void Writer::refuse(const Write& write, std::string_view why) {
  tell(write, {Outcome::refused, std::nullopt, why});
}

std::future<CallAnswer> Writer::ask_safe() {
  auto answer = safe_calls_.ask();
  sink_.on_report(Level::info, "safe values were requested");
  return answer;
}

bool Writer::withdraw(const WriteListener& listener) {
  const auto write = queue_.take_of(listener);
  if (!write) return false;
  queue_.settled(write->point);
  note_owed(*write, false);
  return true;
}

bool Writer::send_now() {
  if (send_error_ || !batch_.empty() || !link_.is_ready()) return false;
  drop_late();
  if (owes_ || withdraws()) return false;
  if (queue_.empty()) return true;     // the owner was faster
  if (!link_.reserve()) return false;  // first: in the queue a newer value may replace it until its turn
  queue_.take(batch_, merges_, false);
  if (batch_.empty()) {
    link_.give_back();
    return false;
  }
  const auto sent = link_.send(batch_.request());
  is_sent_ = sent.has_value();
  if (is_sent_) return true;
  send_error_ = sent.error();
  wait_again();
  return false;
}

void Writer::fire_deadmen() {
  while (const auto expired = deadmen_.take_expired(clock_.now())) {
    const Point& point = map_.points[expired->point];
    const HostOptions::Deadman& deadman = point.host.deadman;
    Write write = make_write(map_, expired->point, deadman.value);
    write.of_deadman = write.ordered = true;
    WriteQueue::Pushed pushed;
    try {
      pushed = queue_.push(write);
    } catch (...) {  // there is no memory for another place
      deadmen_.put_back(*expired);
      throw;
    }
    if (pushed.superseded) tell(*pushed.superseded, {Outcome::superseded});
    if (!pushed.accepted) {  // it goes when there is room: the queue is being emptied
      deadmen_.put_back(*expired);
      return;
    }
    if (expired->again) continue;
    sink_.on_report(Level::warning, fmt::format("no message for {} in {} ms: its deadman value{} is written",
                                                point.name, deadman.timeout.count(), deadman_value(point)));
  }
}

Result<> Writer::step() {
  if (send_error_) return tl::make_unexpected(*std::exchange(send_error_, std::nullopt));
  if (is_sent_) return finish(link_.receive());
  if (is_safe_asked()) return make_safe();
  fire_deadmen();
  if (queue_.empty() && !owes_) {
    link_.give_back();
    return {};
  }
  // First, since what goes before all others, or replaces them, may come meanwhile.
  link_.await_turn_to_write([this] { return is_safe_asked() || withdraws(); });
  if (is_safe_asked()) return make_safe();
  fire_deadmen();
  drop_late();
  if (const std::vector<Write> owed = take_owed(); !owed.empty()) return restore(owed);
  if (!withdraws()) queue_.take(batch_, merges_);
  if (batch_.empty()) {  // they were too late, or are being withdrawn
    link_.give_back();
    return {};
  }
  const auto sent = send(batch_, map_, link_);
  return sent ? finish(link_.receive()) : not_sent(sent.error());
}

void Writer::wait_again() {
  queue_.put_back(batch_.writes());
  batch_.clear();
}

Result<> Writer::not_sent(const Error& why) {
  if (exception_in(why) != nullptr) return finish(tl::make_unexpected(why));  // of the read before
  wait_again();                                                               // until disconnected()
  return tl::make_unexpected(why);
}

void Writer::drop_late() {
  while (const auto write = queue_.take_late(clock_.now()))
    settle(*write, {Outcome::dropped, std::nullopt, "the device was busy for too long; try again"});
}

Result<> Writer::finish(const Result<>& answer) {
  is_sent_ = false;
  const ExceptionReply* exception = answer ? nullptr : exception_in(answer.error());
  if (!answer && exception == nullptr) return answer;  // disconnected() tells them
  std::swap(batch_, done_);
  if (exception != nullptr && done_.writes().size() > 1 && is_wrong(exception->code)) {
    merges_ = false;
    queue_.put_back(done_.writes());
    sink_.on_report(Level::info,
                    fmt::format("writes to {} and its neighbours were rejected in one request: {}; they are "
                                "written one by one while this connection lasts",
                                name(done_.writes().front().point), to_string(answer.error())));
    clear_done();
    return {};
  }
  Result<> connection = finish_done(answer);
  clear_done();
  return connection;
}

/// Each write has exactly one result, whatever throws before it, in its listener, or after it.
Result<> Writer::finish_done(const Result<>& answer) {
  Result<> connection;
  for (; told_ < done_.writes().size(); ++told_) {
    is_settled_ = false;
    try {
      if (const auto finished = finish_one(done_.writes()[told_], answer, connection); !finished)
        connection = finished;
    } catch (...) {
      if (is_settled_) ++told_;
      throw;
    }
  }
  return connection;
}

void Writer::clear_done() {
  done_.clear();
  told_ = 0;
}

Result<> Writer::finish_one(const Write& write, const Result<>& answer, const Result<>& connection) {
  const ExceptionReply* exception = answer ? nullptr : exception_in(answer.error());
  const bool verifies = map_.points[write.point].host.verify_write;
  // The value that reads back counts for more than an odd acknowledgement.
  if (answer || (verifies && exception != nullptr && exception->other_value)) {
    suspects_.erase(write.point);
    remember(write);
    acknowledged_[write.point] = true;
    if (written_ != nullptr) written_->on_written(write);
    if (verifies) return verify(write, connection);
    settle(write, {Outcome::ok});
    return {};
  }
  const bool is_away = exception == nullptr || is_unit_away(answer.error());
  if (is_away || !is_wrong(exception->code)) {
    // It may be carried out, or what it replaced be no more: nothing older is restored, and a deadman is due.
    last_written_.erase(write.point);
    if (write.of_deadman || (is_away && !write.of_schedule)) remember(write);
    if (write.of_deadman) deadmen_.retry(write.point, deadman_due(write.point, is_away));
  }
  if (exception == nullptr) {
    settle(write, {Outcome::lost, std::nullopt, to_string(answer.error())});
    return answer;
  }
  if (exception->other_value) {
    settle(write, {Outcome::not_taken, std::nullopt, to_string(answer.error())});
    return {};
  }
  const bool is_right = is_node_ && exception->code == modbus::Exception::illegal_function;
  settle(write, {Outcome::exception, exception->code,
                 is_right ? "this client has no right to write it" : std::string_view()});
  return is_away ? answer : Result<>{};
}

Result<> Writer::verify(const Write& write, const Result<>& connection) {
  ReadBack back;
  const Result<> read = connection ? back.read(write, map_, link_) : connection;
  const ExceptionReply* exception = read ? nullptr : exception_in(read.error());
  if (!read && exception == nullptr) return finish_one(write, read);
  WriteResult result;
  if (exception != nullptr) {
    result = {Outcome::not_taken, exception->code};
  } else if (!back.is_equal()) {
    result.outcome = Outcome::not_taken;
    result.written = back.written();
    result.found = back.found();
  }
  settle(write, result);
  return read || !is_unit_away(read.error()) ? Result<>{} : read;
}

/// Adds the points whose deadman values waited to `deadmen`.
void Writer::supersede_for_safe(std::vector<std::uint32_t>& deadmen) {
  while (const auto write = queue_.take_one_of(is_safe_point_)) {
    if (write->of_deadman) deadmen.push_back(write->point);
    settle(*write, {Outcome::superseded});
  }
}

/// If something throws, the deadman values of `deadmen` are due again.
Result<std::vector<RejectedValue>> Writer::replace_by_safe_values(std::vector<std::uint32_t>& deadmen) {
  deadmen.reserve(safe_values_.size());  // first: none is lost for lack of memory
  try {
    supersede_for_safe(deadmen);
    return write_safe_values();
  } catch (...) {
    for (const std::uint32_t point : deadmen) deadmen_.retry(point, Time());
    throw;
  }
}

Result<> Writer::make_safe() {
  const std::size_t asked = safe_calls_.size();
  std::vector<std::uint32_t> deadmen;
  const auto rejected = replace_by_safe_values(deadmen);
  if (!rejected) {
    for (const std::uint32_t point : deadmen)
      if (last_written_.count(point) == 0) deadmen_.retry(point, Time());  // nothing is restored
    safe_calls_.answer(asked, {false, fmt::format("not all outputs have their safe values: {}",
                                                  to_string(rejected.error()))});
    return tl::make_unexpected(rejected.error());
  }
  std::string text = fmt::format("{} of {} outputs have their safe values",
                                 safe_values_.size() - rejected->size(), safe_values_.size());
  for (const auto& [point, reply] : *rejected) {
    text += fmt::format("; {}: {}", name(point), to_string(Error(reply)));
    if (std::count(deadmen.begin(), deadmen.end(), point) > 0)
      deadmen_.retry(point, deadman_due(point, false));
  }
  sink_.on_report(rejected->empty() ? Level::info : Level::error, text);
  if (written_ != nullptr) written_->on_made_safe(safe_values_);  // before a caller who asks for more
  safe_calls_.answer(asked, {rejected->empty(), text});
  return {};
}

/// `on_reconnect: restore` brings these back, and not what was written before them.
Result<std::vector<RejectedValue>> Writer::write_safe_values() {
  for (const Write& write : safe_values_) {
    remember(write);
    owed_.erase(write.point);
  }
  try {
    link_.rank(Rank::safe);
    auto rejected = write_values(safe_values_, map_, link_);
    for (const Write& write : safe_values_) remember(write);  // an older value may have been told meanwhile
    link_.rank(Rank::write);
    link_.give_back();  // where there are none
    return rejected;
  } catch (...) {
    link_.rank(Rank::write);  // the other units wait
    throw;
  }
}

/// The listener has the result whatever throws before.
void Writer::tell(const Write& write, const WriteResult& result) {
  statistics_.wrote(result.outcome);
  try {
    values_.wrote(write.point, result);
  } catch (...) {
    if (write.listener != nullptr) write.listener->on_result(result);
    throw;
  }
  if (write.listener != nullptr) write.listener->on_result(result);
}

void Writer::settle(const Write& write, const WriteResult& result) {
  is_settled_ = true;
  queue_.settled(write.point);
  note_owed(write, result.outcome == Outcome::ok || result.outcome == Outcome::not_taken);
  tell(write, result);
  if (result.outcome != Outcome::ok && result.outcome != Outcome::kept) report(write, result);
}

void Writer::report(const Write& write, const WriteResult& result) {
  const auto line = lines_[static_cast<std::size_t>(result.outcome)].say(
      fmt::format("write to {}: {}", name(write.point), to_string(result)), clock_.now());
  if (line) sink_.on_report(Level::warning, *line);
}

void Writer::report_held_back() {
  for (LogLineLimit& lines : lines_)
    if (const auto line = lines.due(clock_.now())) sink_.on_report(Level::warning, *line);
}

bool Writer::shut_down(bool connected) {
  if (map_.on_shutdown != OnShutdown::safe || safe_values_.empty()) return true;
  if (!connected || send_error_) {
    sink_.on_report(Level::error, "no output could be set to its safe value: not connected");
    return false;
  }
  if (is_sent_) finish(link_.receive());
  auto rejected = write_safe_values();
  // It may be there, behind a line that garbled one frame. There is no later chance.
  if (!rejected && is_unit_away(rejected.error())) rejected = write_safe_values();
  if (!rejected) {
    sink_.on_report(Level::error,
                    "not all outputs could be set to their safe values: " + to_string(rejected.error()));
    return false;
  }
  for (const auto& [point, reply] : *rejected)
    sink_.on_report(Level::error, fmt::format("{} could not be set to its safe value: {}", name(point),
                                              to_string(Error(reply))));
  return rejected->empty();
}

}  // namespace coupler::host
