// SPDX-License-Identifier: Apache-2.0
#include "device/gpio/libgpiod1/event_line.hpp"

#include <fcntl.h>

#include <array>
#include <cerrno>
#include <utility>

namespace coupler::node::libgpiod1 {
namespace {

constexpr unsigned kernel_queue = 16;  ///< events that wait in the kernel; later ones are lost

/// CLOCK_MONOTONIC since Linux 5.7, and so the steady clock's.
TimePoint time_of(const gpiod_line_event& event) {
  return TimePoint(std::chrono::seconds(event.ts.tv_sec) + std::chrono::nanoseconds(event.ts.tv_nsec));
}

}  // namespace

EventLine::EventLine(std::unique_ptr<Request> request, std::chrono::microseconds debounce)
    : request_(std::move(request)),
      descriptor_(gpiod_line_event_get_fd(request_->first())),
      debounce_(debounce, gpiod_line_get_value(request_->first()) == 1) {
  ::fcntl(descriptor_, F_SETFL, ::fcntl(descriptor_, F_GETFL) | O_NONBLOCK);
}

bool EventLine::take_edges() {
  std::array<gpiod_line_event, kernel_queue> events{};
  for (;;) {
    const int count = gpiod_line_event_read_fd_multiple(descriptor_, events.data(), kernel_queue);
    if (count < 0) return errno == EAGAIN || errno == EINTR;
    for (int i = 0; i < count; ++i) {
      const gpiod_line_event& event = events[static_cast<std::size_t>(i)];
      debounce_.edge(event.event_type == GPIOD_LINE_EVENT_RISING_EDGE, time_of(event));
    }
    if (count < static_cast<int>(kernel_queue)) return true;
  }
}

int EventLine::read(Span<int> levels, TimePoint now) {
  if (!take_edges()) return errno;
  const int level = gpiod_line_get_value(request_->first());
  if (level < 0) return errno;
  // The kernel's queue may have been full: the line's level is what counts.
  if ((level == 1) != debounce_.latest()) debounce_.edge(level == 1, now);
  levels[0] = debounce_.level(now) ? 1 : 0;
  return 0;
}

}  // namespace coupler::node::libgpiod1
