// SPDX-License-Identifier: Apache-2.0
#include "coupler/device/gpio/libgpiod1/request.hpp"

#include <array>
#include <cerrno>
#include <utility>

#include "coupler/device/gpio/line_group.hpp"

namespace coupler::device::libgpiod1 {
namespace {

constexpr const char* consumer = "coupler-node";

std::optional<std::string> holder_of(gpiod_chip* chip, unsigned offset) {
  gpiod_line* line = gpiod_chip_get_line(chip, offset);
  if (line == nullptr || gpiod_line_update(line) != 0 || !gpiod_line_is_used(line)) return std::nullopt;
  const char* holder = gpiod_line_consumer(line);
  return holder == nullptr ? "" : holder;
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

Request::Request(ChipHandle chip, const std::vector<LineSpec>& lines)
    : chip_(std::move(chip)), name_(names_of(lines)) {
  gpiod_line_bulk_init(&bulk_);
  for (const LineSpec& wanted : lines)
    if (gpiod_line* line = gpiod_chip_get_line(chip_.get(), wanted.line.offset))
      gpiod_line_bulk_add(&bulk_, line);
}

Request::~Request() {
  if (gpiod_line_bulk_num_lines(&bulk_) > 0 && gpiod_line_is_requested(first()))
    gpiod_line_release_bulk(&bulk_);
}

tl::expected<std::unique_ptr<Request>, std::string> Request::make(const std::vector<LineSpec>& lines,
                                                                  int type) {
  const auto refused = [&](gpiod_chip* chip) {
    return tl::unexpected(
        request_error(lines, errno, [chip](unsigned offset) { return holder_of(chip, offset); }));
  };
  ChipHandle chip(gpiod_chip_open(lines.front().line.chip->path.c_str()), gpiod_chip_close);
  if (!chip) return refused(nullptr);
  gpiod_chip* opened = chip.get();
  std::unique_ptr<Request> request(new Request(std::move(chip), lines));
  if (gpiod_line_bulk_num_lines(request->bulk()) != lines.size()) return refused(opened);

  std::array<int, max_group_size> levels{};
  for (std::size_t i = 0; i < lines.size(); ++i) levels[i] = lines[i].level;
  const gpiod_line_request_config config{consumer, type, flags_of(lines.front().point->line)};
  if (gpiod_line_request_bulk(request->bulk(), &config, levels.data()) != 0) return refused(opened);
  return request;
}

}  // namespace coupler::device::libgpiod1
