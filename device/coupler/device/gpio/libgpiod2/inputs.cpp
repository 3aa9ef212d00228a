// SPDX-License-Identifier: Apache-2.0
#include "coupler/device/gpio/libgpiod2/inputs.hpp"

#include <fcntl.h>

#include <algorithm>
#include <cassert>
#include <cerrno>
#include <utility>

namespace coupler::device::libgpiod2 {
namespace {

constexpr std::size_t events_at_once = 64;

}  // namespace

Inputs::Inputs(Request request, const std::vector<LineSpec>& lines)
    : request_(std::move(request)),
      events_(gpiod_edge_event_buffer_new(events_at_once)),
      lines_(lines.size(), {0, EdgeTally(Edge::both, false)}),
      name_(names_of(lines)) {
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const unsigned offset = lines[i].line.offset;
    const bool level = gpiod_line_request_get_value(request_.lines.get(), offset) == GPIOD_LINE_VALUE_ACTIVE;
    lines_[i] = {offset, EdgeTally(lines[i].counted.value_or(Edge::both), level)};
  }
  ::fcntl(descriptor(), F_SETFL, ::fcntl(descriptor(), F_GETFL) | O_NONBLOCK);
}

int Inputs::read(Span<int> levels, TimePoint) {
  if (gpiod_line_request_get_values(request_.lines.get(), values_.data()) != 0) return errno;
  for (std::size_t i = 0; i < levels.size(); ++i) levels[i] = values_[i] == GPIOD_LINE_VALUE_ACTIVE ? 1 : 0;
  return 0;
}

int Inputs::descriptor() const { return gpiod_line_request_get_fd(request_.lines.get()); }

void Inputs::add(gpiod_edge_event* event) {
  const unsigned offset = gpiod_edge_event_get_line_offset(event);
  const Span<Counted> lines = lines_.all();
  auto* const line =
      std::find_if(lines.begin(), lines.end(), [&](const Counted& l) { return l.offset == offset; });
  assert(line != lines.end());
  const auto sequence = static_cast<std::uint32_t>(gpiod_edge_event_get_line_seqno(event));
  if (const std::uint32_t gap = sequence - line->sequence - 1; gap != 0) line->tally.lose(gap);
  line->sequence = sequence;
  line->tally.edge(gpiod_edge_event_get_event_type(event) == GPIOD_EDGE_EVENT_RISING_EDGE);
}

bool Inputs::take_edges() {
  for (;;) {
    const int count =
        gpiod_line_request_read_edge_events(request_.lines.get(), events_.get(), events_at_once);
    if (count < 0) return errno == EAGAIN || errno == EINTR;
    for (int i = 0; i < count; ++i)
      add(gpiod_edge_event_buffer_get_event(events_.get(), static_cast<unsigned long>(i)));
    if (count < static_cast<int>(events_at_once)) return true;
  }
}

Edges Inputs::edges(std::size_t line, TimePoint) { return lines_[line].tally.take(); }

}  // namespace coupler::device::libgpiod2
