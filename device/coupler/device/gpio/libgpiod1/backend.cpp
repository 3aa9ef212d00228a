// SPDX-License-Identifier: Apache-2.0
#include "coupler/device/gpio/backend.hpp"

#include <fcntl.h>
#include <sys/epoll.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <chrono>
#include <cstdint>
#include <optional>
#include <utility>

#include "coupler/device/gpio/libgpiod1/request.hpp"
#include "coupler/device/gpio/watched_inputs.hpp"

namespace coupler::device::backend {
namespace {

using libgpiod1::Request;

/// Outputs of one request: one system call drives them all.
class ValueOutputs : public OutputGroup {
 public:
  explicit ValueOutputs(std::unique_ptr<Request> request) : request_(std::move(request)) {}
  const std::string& name() const override { return request_->name(); }
  bool is_plugged() override { return request_->is_plugged(); }
  int drive(Span<const int> levels) override {
    return gpiod_line_set_value_bulk(request_->bulk(), levels.data()) == 0 ? 0 : errno;
  }
  int read(Span<int> levels) override {
    return gpiod_line_get_value_bulk(request_->bulk(), levels.data()) == 0 ? 0 : errno;
  }

 private:
  std::unique_ptr<Request> request_;
};

/// Inputs of one request: one system call reads them all.
class ValueInputs : public InputGroup {
 public:
  explicit ValueInputs(std::unique_ptr<Request> request) : request_(std::move(request)) {}
  const std::string& name() const override { return request_->name(); }
  bool is_plugged() override { return request_->is_plugged(); }
  int read(Span<int> levels, TimePoint) override {
    return gpiod_line_get_value_bulk(request_->bulk(), levels.data()) == 0 ? 0 : errno;
  }

 private:
  std::unique_ptr<Request> request_;
};

constexpr unsigned kernel_queue = 16;  ///< events that wait in the kernel; later ones are lost

/// CLOCK_MONOTONIC since Linux 5.7, and so the steady clock's.
TimePoint time_of(const gpiod_line_event& event) {
  return TimePoint(std::chrono::seconds(event.ts.tv_sec) + std::chrono::nanoseconds(event.ts.tv_nsec));
}

/// Inputs that are watched for edges. Each is a request with a descriptor of its own, for that is how
/// libgpiod 1 has it; one descriptor stands for all of them. Its events have no sequence number, and the
/// kernel drops those that come while its queue of 16 is full: a queue that was found full counts as one edge
/// lost, at least. To ask the kernel for the level of each line would take a call for each. So the levels are
/// what the edges say, and with every read the next line in turn is looked at, too: nothing that was missed
/// stays unseen, nor does a chip that is gone.
class EventLines : public WatchedInputs {
 public:
  /// `requests` holds a request for each of `lines`, whose levels are `levels`. `ready` becomes readable when
  /// one of them has an event.
  EventLines(std::vector<std::unique_ptr<Request>> requests, const std::vector<LineSpec>& lines,
             Span<const int> levels, int ready)
      : WatchedInputs(lines, levels), requests_(std::move(requests)), ready_(ready), name_(names_of(lines)) {}
  ~EventLines() override { ::close(ready_); }
  EventLines(const EventLines&) = delete;
  EventLines& operator=(const EventLines&) = delete;

  const std::string& name() const override { return name_; }
  bool is_plugged() override { return requests_.front()->is_plugged(); }
  int read(Span<int> levels, TimePoint now) override;
  int descriptor() const override { return ready_; }
  void take_edges() override;
  bool reports_edges() const override { return reports_edges_; }

 private:
  bool take_waiting();
  bool take(std::size_t line);
  void look_at(std::size_t line);
  void look_at_doubtful();

  std::vector<std::unique_ptr<Request>> requests_;
  int ready_;
  std::size_t next_ = 0;   ///< is looked at with the next read
  bool is_known_ = false;  ///< this process has looked at all of them
  bool reports_edges_ = true;
  std::string name_;
};

int descriptor_of(Request& request) { return gpiod_line_event_get_fd(request.first()); }

/// False: the lines are gone.
bool EventLines::take(std::size_t line) {
  std::array<gpiod_line_event, kernel_queue> events{};
  const int descriptor = descriptor_of(*requests_[line]);
  bool was_full = false;
  for (;;) {
    const int count = gpiod_line_event_read_fd_multiple(descriptor, events.data(), kernel_queue);
    if (count < 0 && errno != EAGAIN && errno != EINTR) return false;
    for (int i = 0; i < count; ++i) {
      const gpiod_line_event& event = events[static_cast<std::size_t>(i)];
      edge(line, event.event_type == GPIOD_LINE_EVENT_RISING_EDGE, time_of(event));
    }
    if (count < static_cast<int>(kernel_queue)) break;
    lose(line, 1);
    was_full = true;
  }
  if (was_full) look_at(line);  // the newest edges are those that the kernel dropped
  return true;
}

/// False: the lines are gone.
bool EventLines::take_waiting() {
  std::array<epoll_event, max_group_size> waiting{};
  const int count = ::epoll_wait(ready_, waiting.data(), static_cast<int>(waiting.size()), 0);
  for (int i = 0; i < count; ++i)
    if (!take(waiting[static_cast<std::size_t>(i)].data.u32)) return false;
  return true;
}

void EventLines::take_edges() {
  reports_edges_ = take_waiting();
  if (!reports_edges_) return fail_all(errno, TimePoint::clock::now());
  if (std::exchange(is_known_, true)) {
    look_at_doubtful();
  } else {
    // A process that died may have taken edges and not noted them.
    for (std::size_t line = 0; line < size(); ++line) look_at(line);
  }
}

void EventLines::look_at_doubtful() {
  if (!has_doubts()) return;
  const TimePoint now = TimePoint::clock::now();
  for (std::size_t line = 0; line < size(); ++line)
    if (is_doubtful(line, now)) look_at(line);
}

/// If that fails, read() says so until it works again.
void EventLines::look_at(std::size_t line) {
  const int level = gpiod_line_get_value(requests_[line]->first());
  if (level < 0)
    fail(line, errno, TimePoint::clock::now());
  else
    check(line, level == 1, TimePoint::clock::now());
}

int EventLines::read(Span<int> levels, TimePoint now) {
  take_edges();
  if (reports_edges_) {
    next_ = (next_ + 1) % size();
    look_at(next_);
  }
  put_levels(levels, now);
  return error();
}

tl::expected<std::unique_ptr<InputGroup>, std::string> request_event_lines(
    const std::vector<LineSpec>& lines) {
  std::vector<std::unique_ptr<Request>> requests;
  std::vector<int> levels;
  for (const LineSpec& line : lines) {
    auto request = Request::make({line}, GPIOD_LINE_REQUEST_EVENT_BOTH_EDGES);
    if (!request) return tl::unexpected(std::move(request).error());
    levels.push_back(gpiod_line_get_value((*request)->first()) == 1 ? 1 : 0);
    requests.push_back(*std::move(request));
  }
  const int ready = ::epoll_create1(EPOLL_CLOEXEC);
  const auto watch = [&](std::size_t line) {
    const int descriptor = descriptor_of(*requests[line]);
    ::fcntl(descriptor, F_SETFL, ::fcntl(descriptor, F_GETFL) | O_NONBLOCK);
    epoll_event event{};
    event.events = EPOLLIN | EPOLLPRI;
    event.data.u32 = static_cast<std::uint32_t>(line);
    return ::epoll_ctl(ready, EPOLL_CTL_ADD, descriptor, &event) == 0;
  };
  bool watched = ready >= 0;
  for (std::size_t line = 0; watched && line < lines.size(); ++line) watched = watch(line);
  if (watched) return std::make_unique<EventLines>(std::move(requests), lines, levels, ready);
  std::string error = request_error(lines, errno, [](unsigned) { return std::nullopt; });
  if (ready >= 0) ::close(ready);
  return tl::unexpected(std::move(error));
}

/// nullopt with errno set if it cannot be opened.
std::optional<Chip> read_chip(const std::string& path) {
  const libgpiod1::ChipHandle chip(gpiod_chip_open(path.c_str()), gpiod_chip_close);
  if (!chip) return std::nullopt;
  Chip read{path, gpiod_chip_name(chip.get()), gpiod_chip_label(chip.get()), {}};
  read.lines.resize(gpiod_chip_num_lines(chip.get()));
  for (unsigned offset = 0; offset < read.lines.size(); ++offset) {
    gpiod_line* line = gpiod_chip_get_line(chip.get(), offset);
    const char* name = line == nullptr ? nullptr : gpiod_line_name(line);
    if (name != nullptr) read.lines[offset] = name;
  }
  return read;
}

}  // namespace

Inventory chips() { return Inventory(read_chip); }

std::size_t max_watched() { return 64; }

bool fits(const std::vector<LineSpec>& group, const LineSpec& line) {
  const LineSpec& first = group.front();
  if (first.line.chip != line.line.chip || is_output(first) != is_output(line) ||
      is_watched(first) != is_watched(line))
    return false;
  return is_watched(line) || libgpiod1::flags_of(first.point->line) == libgpiod1::flags_of(line.point->line);
}

tl::expected<std::unique_ptr<OutputGroup>, std::string> request_outputs(const std::vector<LineSpec>& lines) {
  auto request = Request::make(lines, GPIOD_LINE_REQUEST_DIRECTION_OUTPUT);
  if (!request) return tl::unexpected(std::move(request).error());
  return std::make_unique<ValueOutputs>(*std::move(request));
}

tl::expected<std::unique_ptr<InputGroup>, std::string> request_inputs(const std::vector<LineSpec>& lines) {
  if (is_watched(lines.front())) return request_event_lines(lines);
  auto request = Request::make(lines, GPIOD_LINE_REQUEST_DIRECTION_INPUT);
  if (!request) return tl::unexpected(std::move(request).error());
  return std::make_unique<ValueInputs>(*std::move(request));
}

}  // namespace coupler::device::backend
