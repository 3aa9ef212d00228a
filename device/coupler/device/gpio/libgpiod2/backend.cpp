// SPDX-License-Identifier: Apache-2.0
#include "coupler/device/gpio/backend.hpp"

#include <fcntl.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cerrno>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <utility>

#include "coupler/device/gpio/libgpiod2/request.hpp"
#include "coupler/device/gpio/watched_inputs.hpp"
#include "coupler/device/supervisor/shared_memory.hpp"

namespace coupler::device::backend {
namespace {

using namespace libgpiod2;

/// Outputs of one request: one system call drives them all.
class Outputs : public OutputGroup {
 public:
  Outputs(Request request, std::string name) : request_(std::move(request)), name_(std::move(name)) {}
  const std::string& name() const override { return name_; }
  bool is_plugged() override { return request_.is_plugged(); }
  int drive(Span<const int> levels) override {
    for (std::size_t i = 0; i < levels.size(); ++i)
      values_[i] = levels[i] != 0 ? GPIOD_LINE_VALUE_ACTIVE : GPIOD_LINE_VALUE_INACTIVE;
    return gpiod_line_request_set_values(request_.lines.get(), values_.data()) == 0 ? 0 : errno;
  }
  int read(Span<int> levels) override { return request_.read(levels); }

 private:
  Request request_;
  std::array<gpiod_line_value, max_group_size> values_{};
  std::string name_;
};

constexpr std::size_t events_at_once = 64;

/// Inputs of one request: one system call reads them all.
class Inputs : public InputGroup {
 public:
  Inputs(Request request, std::string name) : request_(std::move(request)), name_(std::move(name)) {}
  const std::string& name() const override { return name_; }
  bool is_plugged() override { return request_.is_plugged(); }
  int read(Span<int> levels, TimePoint) override { return request_.read(levels); }

 private:
  Request request_;
  std::string name_;
};

/// The same, and one descriptor reports the edges of all of them. The kernel numbers its events: what it
/// drops is seen as a gap. It could debounce, but its time stamps are those of the end of the period then.
class EventInputs : public WatchedInputs {
 public:
  /// `request` holds `lines`, in this order, which have `levels`.
  EventInputs(Request request, const std::vector<LineSpec>& lines, Span<const int> levels);

  const std::string& name() const override { return name_; }
  bool is_plugged() override { return request_.is_plugged(); }
  int read(Span<int> levels, TimePoint now) override;
  int descriptor() const override { return gpiod_line_request_get_fd(request_.lines.get()); }
  void take_edges() override;
  bool reports_edges() const override { return reports_edges_; }

 private:
  struct Reported {
    unsigned offset = 0;
    std::uint32_t sequence = 0;  ///< of the line's last event; the kernel begins with 1
  };

  bool take_waiting();
  void add(gpiod_edge_event* event);
  int look_at_all();

  Request request_;
  Owned<gpiod_edge_event_buffer, gpiod_edge_event_buffer_free> events_;
  SharedArray<Reported> reported_;  ///< shared: a process that is started anew sees no gap in their sequence
  bool is_known_ = false;           ///< this process has looked at the lines
  bool reports_edges_ = true;
  std::string name_;
};

EventInputs::EventInputs(Request request, const std::vector<LineSpec>& lines, Span<const int> levels)
    : WatchedInputs(lines, levels),
      request_(std::move(request)),
      events_(gpiod_edge_event_buffer_new(events_at_once)),
      reported_(lines.size()),
      name_(names_of(lines)) {
  for (std::size_t i = 0; i < lines.size(); ++i) reported_[i].offset = lines[i].line.offset;
  const int fd = gpiod_line_request_get_fd(request_.lines.get());
  ::fcntl(fd, F_SETFL, ::fcntl(fd, F_GETFL) | O_NONBLOCK);
}

void EventInputs::add(gpiod_edge_event* event) {
  const unsigned offset = gpiod_edge_event_get_line_offset(event);
  const Span<Reported> all = reported_.all();
  auto* const line =
      std::find_if(all.begin(), all.end(), [&](const Reported& one) { return one.offset == offset; });
  assert(line != all.end());
  const auto i = static_cast<std::size_t>(line - all.begin());
  const auto sequence = static_cast<std::uint32_t>(gpiod_edge_event_get_line_seqno(event));
  if (const std::uint32_t gap = sequence - line->sequence - 1; gap != 0) lose(i, gap);
  line->sequence = sequence;
  const std::chrono::nanoseconds at(gpiod_edge_event_get_timestamp_ns(event));
  edge(i, gpiod_edge_event_get_event_type(event) == GPIOD_EDGE_EVENT_RISING_EDGE, TimePoint(at));
}

/// False: the lines are gone.
bool EventInputs::take_waiting() {
  for (;;) {
    const int count =
        gpiod_line_request_read_edge_events(request_.lines.get(), events_.get(), events_at_once);
    if (count < 0) return errno == EAGAIN || errno == EINTR;
    for (int i = 0; i < count; ++i)
      add(gpiod_edge_event_buffer_get_event(events_.get(), static_cast<unsigned long>(i)));
    if (count < static_cast<int>(events_at_once)) return true;
  }
}

void EventInputs::take_edges() {
  reports_edges_ = take_waiting();
  if (!reports_edges_) return fail_all(errno, TimePoint::clock::now());
  // A process that died may have taken edges and not noted them. Edges can be taken if looking fails, too.
  if (!std::exchange(is_known_, true) || has_doubts()) (void)look_at_all();
}

/// Returns 0 or an errno.
int EventInputs::look_at_all() {
  std::array<int, max_group_size> space{};
  const auto levels = Span<int>(space).first(size());
  int error = request_.read(levels);
  if (error == 0 && !take_waiting()) error = errno;  // first the edges that were reported
  const TimePoint now = TimePoint::clock::now();
  if (error != 0) {
    fail_all(error, now);
    return error;
  }
  for (std::size_t i = 0; i < size(); ++i) check(i, levels[i] != 0, now);
  return 0;
}

int EventInputs::read(Span<int> levels, TimePoint now) {
  const int error = look_at_all();
  put_levels(levels, now);
  return error;
}

std::size_t kinds(const std::vector<LineSpec>& lines) {
  std::size_t count = 0;
  for (auto line = lines.begin(); line != lines.end(); ++line)
    if (std::none_of(lines.begin(), line, [&](const LineSpec& other) { return same_kind(other, *line); }))
      ++count;
  return count;
}

/// nullopt with errno set if it cannot be opened.
std::optional<Chip> read_chip(const std::string& path) {
  const ChipHandle chip(gpiod_chip_open(path.c_str()));
  if (!chip) return std::nullopt;
  const Owned<gpiod_chip_info, gpiod_chip_info_free> info(gpiod_chip_get_info(chip.get()));
  if (!info) return std::nullopt;
  Chip read{path, gpiod_chip_info_get_name(info.get()), gpiod_chip_info_get_label(info.get()), {}};
  read.lines.resize(gpiod_chip_info_get_num_lines(info.get()));
  for (unsigned offset = 0; offset < read.lines.size(); ++offset) {
    const Owned<gpiod_line_info, gpiod_line_info_free> line(gpiod_chip_get_line_info(chip.get(), offset));
    const char* name = line ? gpiod_line_info_get_name(line.get()) : nullptr;
    if (name != nullptr) read.lines[offset] = name;
  }
  return read;
}

}  // namespace

Inventory chips() { return Inventory(read_chip); }

std::size_t max_watched() { return std::numeric_limits<std::size_t>::max(); }

bool fits(const std::vector<LineSpec>& group, const LineSpec& line) {
  const LineSpec& first = group.front();
  if (first.line.chip != line.line.chip || is_output(first) != is_output(line) ||
      is_watched(first) != is_watched(line))
    return false;
  const bool known =
      std::any_of(group.begin(), group.end(), [&](const LineSpec& other) { return same_kind(other, line); });
  return known || kinds(group) < max_kinds;
}

tl::expected<std::unique_ptr<OutputGroup>, std::string> request_outputs(const std::vector<LineSpec>& lines) {
  auto made = request(lines);
  if (!made) return tl::unexpected(std::move(made).error());
  return std::make_unique<Outputs>(*std::move(made), names_of(lines));
}

tl::expected<std::unique_ptr<InputGroup>, std::string> request_inputs(const std::vector<LineSpec>& lines) {
  auto made = request(lines);
  if (!made) return tl::unexpected(std::move(made).error());
  if (!is_watched(lines.front())) return std::make_unique<Inputs>(*std::move(made), names_of(lines));
  std::array<int, max_group_size> levels{};
  (void)made->read(Span<int>(levels).first(lines.size()));  // if it fails, so does the next, which is told
  return std::make_unique<EventInputs>(*std::move(made), lines, levels);
}

}  // namespace coupler::device::backend
