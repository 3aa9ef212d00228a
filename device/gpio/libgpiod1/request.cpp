// SPDX-License-Identifier: Apache-2.0
#include "device/gpio/libgpiod1/request.hpp"

#include <fmt/format.h>

#include <array>
#include <cerrno>
#include <cstring>

#include "device/gpio/line_group.hpp"

namespace coupler::node::libgpiod1 {
namespace {

constexpr const char* consumer = "coupler-node";

std::string name_of(const std::vector<Wanted>& lines) {
  constexpr std::size_t enough = 8;
  std::string text = to_string(lines.front().found);
  for (std::size_t i = 1; i < lines.size(); ++i) {
    if (i == enough) return text + fmt::format(" and {} more", lines.size() - i);
    text += ", " + to_string(lines[i].found);
  }
  return text;
}

int kernel_type(Use use) {
  switch (use) {
    case Use::input: return GPIOD_LINE_REQUEST_DIRECTION_INPUT;
    case Use::output: return GPIOD_LINE_REQUEST_DIRECTION_OUTPUT;
    case Use::edges: return GPIOD_LINE_REQUEST_EVENT_BOTH_EDGES;
  }
  return 0;
}

/// The kernel refuses a request as a whole; whose fault it was is found line by line.
std::string busy_lines(const std::vector<Wanted>& lines) {
  std::string text;
  for (const Wanted& wanted : lines) {
    gpiod_line* line = wanted.found.line;
    if (gpiod_line_update(line) != 0 || !gpiod_line_is_used(line)) continue;
    const char* holder = gpiod_line_consumer(line);
    text += fmt::format("{}point '{}': {} is busy: held by {}; release it there or choose another line",
                        text.empty() ? "" : "\n", wanted.point->name, to_string(wanted.found),
                        holder == nullptr ? "the kernel" : fmt::format("'{}'", holder));
  }
  return text;
}

std::string refusal(const std::vector<Wanted>& lines, int error) {
  if (error == EBUSY)
    if (std::string busy = busy_lines(lines); !busy.empty()) return busy;
  const char* remedy = "";
  if (error == EACCES || error == EPERM)
    remedy = "; run as a user who may write to the chip's device in /dev";
  if (error == EINVAL || error == ENOTSUP || error == ENXIO || error == EIO)
    remedy = "; check that the chip can do what the map asks (direction, bias, drive, edges for debounce)";
  return fmt::format("point '{}': {} cannot be requested: {}{}", lines.front().point->name, name_of(lines),
                     std::strerror(error), remedy);
}

}  // namespace

int flags_of(const Line& line) {
  int flags = line.active_low ? GPIOD_LINE_REQUEST_FLAG_ACTIVE_LOW : 0;
  switch (line.drive) {
    case Drive::push_pull: break;
    case Drive::open_drain: flags |= GPIOD_LINE_REQUEST_FLAG_OPEN_DRAIN; break;
    case Drive::open_source: flags |= GPIOD_LINE_REQUEST_FLAG_OPEN_SOURCE; break;
  }
  switch (line.bias) {
    case Bias::as_is: break;
    case Bias::none: flags |= GPIOD_LINE_REQUEST_FLAG_BIAS_DISABLE; break;
    case Bias::pull_up: flags |= GPIOD_LINE_REQUEST_FLAG_BIAS_PULL_UP; break;
    case Bias::pull_down: flags |= GPIOD_LINE_REQUEST_FLAG_BIAS_PULL_DOWN; break;
  }
  return flags;
}

int initial_level(const Point& point) { return !point.initial.empty() && point.initial[0] != 0 ? 1 : 0; }

Request::Request(const std::vector<Wanted>& lines) : chip_(lines.front().found.chip), name_(name_of(lines)) {
  gpiod_line_bulk_init(&bulk_);
  for (const Wanted& wanted : lines) gpiod_line_bulk_add(&bulk_, wanted.found.line);
}

Request::~Request() {
  if (gpiod_line_is_requested(first())) gpiod_line_release_bulk(&bulk_);
}

tl::expected<std::unique_ptr<Request>, std::string> Request::make(const std::vector<Wanted>& lines, Use use) {
  std::unique_ptr<Request> request(new Request(lines));
  std::array<int, max_group_size> levels{};
  for (std::size_t i = 0; i < lines.size(); ++i) levels[i] = initial_level(*lines[i].point);
  const gpiod_line_request_config config{consumer, kernel_type(use), flags_of(lines.front().point->line)};
  if (gpiod_line_request_bulk(request->bulk(), &config, levels.data()) != 0)
    return tl::unexpected(refusal(lines, errno));
  return request;
}

}  // namespace coupler::node::libgpiod1
