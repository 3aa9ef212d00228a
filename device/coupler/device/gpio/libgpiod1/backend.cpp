// SPDX-License-Identifier: Apache-2.0
#include "coupler/device/gpio/backend.hpp"

#include <fcntl.h>

#include <array>
#include <cerrno>
#include <chrono>
#include <optional>
#include <utility>

#include "coupler/device/gpio/libgpiod1/request.hpp"
#include "coupler/device/gpio/line_edges.hpp"
#include "coupler/device/supervisor/shared_memory.hpp"

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

/// An input that is watched for edges: because they are counted, or to debounce it here, since libgpiod 1
/// has no debounce. Each such line has a descriptor of its own. Its events have no sequence number, and the
/// kernel drops those that come while its queue of 16 is full: a queue that was found full counts as one
/// edge lost, at least.
class EventLine : public InputGroup {
 public:
  /// `request` holds one line, requested for `watched` edges; both, if there is a debounce period.
  EventLine(std::unique_ptr<Request> request, Edge watched, std::chrono::microseconds debounce);

  const std::string& name() const override { return request_->name(); }
  bool is_plugged() override { return request_->is_plugged(); }
  int read(Span<int> levels, TimePoint now) override;
  int descriptor() const override { return descriptor_; }
  bool take_edges() override;
  Edges edges(std::size_t line, TimePoint now) override;

 private:
  void add(const gpiod_line_event& event);
  /// The line's own level is what counts where the queue may have been full. Returns 0 or an errno.
  int debounce_level(TimePoint now);

  /// What was seen of the line. Shared, so that a process that is started anew takes no edge for a lost one.
  struct Seen {
    EdgeTally tally;
    std::optional<Debounce> debounce;
  };
  EdgeTally& tally() { return seen_[0].tally; }
  std::optional<Debounce>& debounce() { return seen_[0].debounce; }

  std::unique_ptr<Request> request_;
  int descriptor_;
  SharedArray<Seen> seen_;
};

EventLine::EventLine(std::unique_ptr<Request> request, Edge watched, std::chrono::microseconds debounce)
    : request_(std::move(request)),
      descriptor_(gpiod_line_event_get_fd(request_->first())),
      seen_(1, {EdgeTally(watched, gpiod_line_get_value(request_->first()) == 1), std::nullopt}) {
  if (debounce.count() > 0) this->debounce().emplace(debounce, gpiod_line_get_value(request_->first()) == 1);
  ::fcntl(descriptor_, F_SETFL, ::fcntl(descriptor_, F_GETFL) | O_NONBLOCK);
}

void EventLine::add(const gpiod_line_event& event) {
  const bool rising = event.event_type == GPIOD_LINE_EVENT_RISING_EDGE;
  if (debounce())
    debounce()->edge(rising, time_of(event));
  else
    tally().edge(rising);
}

bool EventLine::take_edges() {
  std::array<gpiod_line_event, kernel_queue> events{};
  for (;;) {
    const int count = gpiod_line_event_read_fd_multiple(descriptor_, events.data(), kernel_queue);
    if (count < 0) return errno == EAGAIN || errno == EINTR;
    for (int i = 0; i < count; ++i) add(events[static_cast<std::size_t>(i)]);
    if (count < static_cast<int>(kernel_queue)) return true;
    tally().lose(1);
  }
}

int EventLine::debounce_level(TimePoint now) {
  const int level = gpiod_line_get_value(request_->first());
  if (level < 0) return errno;
  if ((level == 1) != debounce()->latest()) debounce()->edge(level == 1, now);
  return 0;
}

Edges EventLine::edges(std::size_t, TimePoint now) {
  Edges edges = tally().take();
  if (!debounce()) return edges;
  const std::uint32_t lost = edges.lost;
  if (lost != 0 && debounce_level(now) != 0) return edges;
  edges = debounce()->take_edges(now);
  edges.lost = lost;
  return edges;
}

int EventLine::read(Span<int> levels, TimePoint now) {
  if (!take_edges()) return errno;
  if (debounce()) {
    const int error = debounce_level(now);
    levels[0] = debounce()->level(now) ? 1 : 0;
    return error;
  }
  levels[0] = gpiod_line_get_value(request_->first());
  return levels[0] < 0 ? errno : 0;
}

/// libgpiod 1 has no debounce: it is made of both edges and their times.
std::optional<Edge> edges_of(const LineSpec& wanted) {
  if (is_output(wanted)) return std::nullopt;
  return wanted.point->line.debounce.count() > 0 ? Edge::both : wanted.counted;
}

int request_type(Edge edge) {
  switch (edge) {
    case Edge::rising: return GPIOD_LINE_REQUEST_EVENT_RISING_EDGE;
    case Edge::falling: return GPIOD_LINE_REQUEST_EVENT_FALLING_EDGE;
    case Edge::both: break;
  }
  return GPIOD_LINE_REQUEST_EVENT_BOTH_EDGES;
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

bool fits(const std::vector<LineSpec>& group, const LineSpec& line) {
  const LineSpec& first = group.front();
  return first.line.chip == line.line.chip && is_output(first) == is_output(line) && !edges_of(first) &&
         !edges_of(line) && libgpiod1::flags_of(first.point->line) == libgpiod1::flags_of(line.point->line);
}

tl::expected<std::unique_ptr<OutputGroup>, std::string> request_outputs(const std::vector<LineSpec>& lines) {
  auto request = Request::make(lines, GPIOD_LINE_REQUEST_DIRECTION_OUTPUT);
  if (!request) return tl::unexpected(std::move(request).error());
  return std::make_unique<ValueOutputs>(*std::move(request));
}

tl::expected<std::unique_ptr<InputGroup>, std::string> request_inputs(const std::vector<LineSpec>& lines) {
  const auto edges = edges_of(lines.front());
  auto request = Request::make(lines, edges ? request_type(*edges) : GPIOD_LINE_REQUEST_DIRECTION_INPUT);
  if (!request) return tl::unexpected(std::move(request).error());
  if (!edges) return std::make_unique<ValueInputs>(*std::move(request));
  return std::make_unique<EventLine>(*std::move(request), *edges, lines.front().point->line.debounce);
}

}  // namespace coupler::device::backend
