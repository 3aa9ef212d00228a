// SPDX-License-Identifier: Apache-2.0
#include "coupler/device/gpio/libgpiod1/event_line.hpp"

#include <fcntl.h>

#include <array>
#include <cerrno>
#include <utility>

namespace coupler::device::libgpiod1 {
namespace {

constexpr unsigned kernel_queue = 16;  ///< events that wait in the kernel; later ones are lost

/// CLOCK_MONOTONIC since Linux 5.7, and so the steady clock's.
TimePoint time_of(const gpiod_line_event& event) {
  return TimePoint(std::chrono::seconds(event.ts.tv_sec) + std::chrono::nanoseconds(event.ts.tv_nsec));
}

}  // namespace

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

}  // namespace coupler::device::libgpiod1
