// SPDX-License-Identifier: Apache-2.0
#include "coupler/device/gpio/libgpiod2/request.hpp"

#include <cerrno>
#include <utility>

#include "coupler/device/gpio/line_group.hpp"

namespace coupler::device::libgpiod2 {
namespace {

constexpr const char* consumer = "coupler-node";
/// Events that the kernel keeps for a request; its limit.
constexpr std::size_t kernel_queue = 1024;

using Settings = Owned<gpiod_line_settings, gpiod_line_settings_free>;
using LineConfig = Owned<gpiod_line_config, gpiod_line_config_free>;
using RequestConfig = Owned<gpiod_request_config, gpiod_request_config_free>;
using LineInfo = Owned<gpiod_line_info, gpiod_line_info_free>;

std::optional<std::string> holder_of(gpiod_chip* chip, unsigned offset) {
  const LineInfo info(gpiod_chip_get_line_info(chip, offset));
  if (!info || !gpiod_line_info_is_used(info.get())) return std::nullopt;
  const char* holder = gpiod_line_info_get_consumer(info.get());
  return holder == nullptr ? "" : holder;
}

gpiod_line_bias bias_of(Bias bias) {
  switch (bias) {
    case Bias::none: return GPIOD_LINE_BIAS_DISABLED;
    case Bias::pull_up: return GPIOD_LINE_BIAS_PULL_UP;
    case Bias::pull_down: return GPIOD_LINE_BIAS_PULL_DOWN;
    case Bias::as_is: break;
  }
  return GPIOD_LINE_BIAS_AS_IS;
}

gpiod_line_drive drive_of(Drive drive) {
  switch (drive) {
    case Drive::open_drain: return GPIOD_LINE_DRIVE_OPEN_DRAIN;
    case Drive::open_source: return GPIOD_LINE_DRIVE_OPEN_SOURCE;
    case Drive::push_pull: break;
  }
  return GPIOD_LINE_DRIVE_PUSH_PULL;
}

void set_output(gpiod_line_settings* settings, const LineSpec& wanted) {
  gpiod_line_settings_set_direction(settings, GPIOD_LINE_DIRECTION_OUTPUT);
  gpiod_line_settings_set_drive(settings, drive_of(wanted.point->line.drive));
  gpiod_line_settings_set_output_value(
      settings, wanted.level != 0 ? GPIOD_LINE_VALUE_ACTIVE : GPIOD_LINE_VALUE_INACTIVE);
}

void set_input(gpiod_line_settings* settings, const LineSpec& wanted) {
  gpiod_line_settings_set_direction(settings, GPIOD_LINE_DIRECTION_INPUT);
  gpiod_line_settings_set_edge_detection(settings,
                                         wanted.watched ? GPIOD_LINE_EDGE_BOTH : GPIOD_LINE_EDGE_NONE);
}

/// False with errno set if there is no memory or the settings contradict each other.
bool add(gpiod_line_config* config, const LineSpec& wanted) {
  const Settings settings(gpiod_line_settings_new());
  if (!settings) return false;
  gpiod_line_settings_set_active_low(settings.get(), wanted.point->line.active_low);
  gpiod_line_settings_set_bias(settings.get(), bias_of(wanted.point->line.bias));
  if (is_output(wanted))
    set_output(settings.get(), wanted);
  else
    set_input(settings.get(), wanted);
  return gpiod_line_config_add_line_settings(config, &wanted.line.offset, 1, settings.get()) == 0;
}

}  // namespace

bool same_kind(const LineSpec& a, const LineSpec& b) {
  const Line& x = a.point->line;
  const Line& y = b.point->line;
  return x.active_low == y.active_low && x.bias == y.bias && x.drive == y.drive;
}

tl::expected<Request, std::string> request(const std::vector<LineSpec>& lines) {
  ChipHandle chip(gpiod_chip_open(lines.front().line.chip->path.c_str()));
  const auto refused = [&] {
    return tl::unexpected(
        request_error(lines, errno, [&](unsigned offset) { return holder_of(chip.get(), offset); }));
  };
  const LineConfig config(gpiod_line_config_new());
  const RequestConfig options(gpiod_request_config_new());
  if (!chip || !config || !options) return refused();
  gpiod_request_config_set_consumer(options.get(), consumer);
  gpiod_request_config_set_event_buffer_size(options.get(), kernel_queue);
  for (const LineSpec& wanted : lines)
    if (!add(config.get(), wanted)) return refused();
  RequestHandle made(gpiod_chip_request_lines(chip.get(), options.get(), config.get()));
  if (!made) return refused();
  return Request{std::move(chip), std::move(made)};
}

}  // namespace coupler::device::libgpiod2
