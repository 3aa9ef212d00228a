// SPDX-License-Identifier: Apache-2.0
#include "coupler/device/gpio/backend.hpp"

#include <fcntl.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cerrno>
#include <cstdint>
#include <utility>

#include "coupler/device/gpio/libgpiod2/request.hpp"
#include "coupler/device/gpio/line_edges.hpp"
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
  int read(Span<int> levels) override {
    if (gpiod_line_request_get_values(request_.lines.get(), values_.data()) != 0) return errno;
    for (std::size_t i = 0; i < levels.size(); ++i) levels[i] = values_[i] == GPIOD_LINE_VALUE_ACTIVE ? 1 : 0;
    return 0;
  }

 private:
  Request request_;
  std::array<gpiod_line_value, max_group_size> values_{};
  std::string name_;
};

constexpr std::size_t events_at_once = 64;

/// Inputs of one request: one system call reads them all, one descriptor reports the edges of those that are
/// counted. The kernel debounces, and numbers its events: what it drops is seen as a gap.
class Inputs : public InputGroup {
 public:
  /// `request` holds `lines`, in this order.
  Inputs(Request request, const std::vector<LineSpec>& lines);

  const std::string& name() const override { return name_; }
  bool is_plugged() override { return request_.is_plugged(); }
  int read(Span<int> levels, TimePoint now) override;
  int descriptor() const override { return is_counted_ ? fd() : -1; }
  bool take_edges() override;
  Edges edges(std::size_t line, TimePoint now) override;

 private:
  struct Counted {
    unsigned offset = 0;
    EdgeTally tally;
    std::uint32_t sequence = 0;  ///< of the line's last event; the kernel begins with 1
  };

  int fd() const { return gpiod_line_request_get_fd(request_.lines.get()); }
  void add(gpiod_edge_event* event);

  Request request_;
  Owned<gpiod_edge_event_buffer, gpiod_edge_event_buffer_free> events_;
  std::array<gpiod_line_value, max_group_size> values_{};
  SharedArray<Counted> lines_;  ///< shared: a process that is started anew sees no gap in their sequence
  bool is_counted_ = false;
  std::string name_;
};

Inputs::Inputs(Request request, const std::vector<LineSpec>& lines)
    : request_(std::move(request)),
      events_(gpiod_edge_event_buffer_new(events_at_once)),
      lines_(lines.size(), {0, EdgeTally(Edge::both, false)}),
      name_(names_of(lines)) {
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const unsigned offset = lines[i].line.offset;
    const bool level = gpiod_line_request_get_value(request_.lines.get(), offset) == GPIOD_LINE_VALUE_ACTIVE;
    is_counted_ |= lines[i].counted.has_value();
    lines_[i] = {offset, EdgeTally(lines[i].counted.value_or(Edge::both), level)};
  }
  ::fcntl(fd(), F_SETFL, ::fcntl(fd(), F_GETFL) | O_NONBLOCK);
}

int Inputs::read(Span<int> levels, TimePoint) {
  if (gpiod_line_request_get_values(request_.lines.get(), values_.data()) != 0) return errno;
  for (std::size_t i = 0; i < levels.size(); ++i) levels[i] = values_[i] == GPIOD_LINE_VALUE_ACTIVE ? 1 : 0;
  return 0;
}

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

bool fits(const std::vector<LineSpec>& group, const LineSpec& line) {
  if (group.front().line.chip != line.line.chip || is_output(group.front()) != is_output(line)) return false;
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
  return std::make_unique<Inputs>(*std::move(made), lines);
}

}  // namespace coupler::device::backend
