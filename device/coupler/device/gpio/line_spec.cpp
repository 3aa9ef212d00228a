// SPDX-License-Identifier: Apache-2.0
#include "coupler/device/gpio/line_spec.hpp"

#include <fmt/format.h>

#include <cerrno>
#include <cstring>

#include "coupler/device/gpio/grouped_lines.hpp"

namespace coupler::device {
namespace {

std::string busy_lines(const std::vector<LineSpec>& lines, const HolderOf& holder_of) {
  std::string text;
  for (const LineSpec& wanted : lines) {
    const auto holder = holder_of(wanted.line.offset);
    if (!holder) continue;
    text += fmt::format("{}point '{}': {} is busy: held by {}; release it there or choose another line",
                        text.empty() ? "" : "\n", wanted.point->name, to_string(wanted.line),
                        holder->empty() ? "the kernel" : fmt::format("'{}'", *holder));
  }
  return text;
}

}  // namespace

int first_level(const Point& point, bool safe) {
  const int initial = !point.initial.empty() && point.initial[0] != 0 ? 1 : 0;
  return safe ? safe_level(point.safe, initial) : initial;
}

std::string names_of(const std::vector<LineSpec>& lines) {
  constexpr std::size_t enough = 8;
  std::string text = to_string(lines.front().line);
  for (std::size_t i = 1; i < lines.size(); ++i) {
    if (i == enough) return text + fmt::format(" and {} more", lines.size() - i);
    text += ", " + to_string(lines[i].line);
  }
  return text;
}

std::string refusal(const std::vector<LineSpec>& lines, int error, const HolderOf& holder_of) {
  if (error == EBUSY)
    if (std::string busy = busy_lines(lines, holder_of); !busy.empty()) return busy;
  const char* remedy = "";
  if (error == EACCES || error == EPERM)
    remedy = "; run as a user who may write to the chip's device in /dev";
  if (error == EINVAL || error == ENOTSUP || error == ENXIO || error == EIO || error == ENODEV)
    remedy =
        "; check that the chip can do what the map asks (direction, bias, drive, edges for counters, latched "
        "points and debounce)";
  return fmt::format("point '{}': {} cannot be requested: {}{}", lines.front().point->name, names_of(lines),
                     std::strerror(error), remedy);
}

}  // namespace coupler::device
