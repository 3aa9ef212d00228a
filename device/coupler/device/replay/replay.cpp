// SPDX-License-Identifier: Apache-2.0
#include "coupler/device/replay/replay.hpp"

#include <cerrno>
#include <cstring>
#include <fstream>
#include <utility>

#include <fmt/format.h>

#include "coupler/base/utc_text.hpp"
#include "coupler/device/log/stderr_log.hpp"
#include "coupler/device/node/map_reading.hpp"
#include "coupler/device/node/program.hpp"
#include "coupler/device/node/serving_context.hpp"
#include "coupler/device/replay/player.hpp"
#include "coupler/device/replay/replay_time.hpp"
#include "coupler/map/name_pattern.hpp"

namespace coupler::device {
namespace {

constexpr int wrong_call = 2;
constexpr double longest_replay = 1e9;  ///< s

tl::unexpected<ReplayError> problem(int exit, std::string text) {
  return tl::unexpected(ReplayError{exit, std::move(text)});
}

tl::expected<ReplayOptions, ReplayError> understand(const ReplayArguments& arguments,
                                                    const Recording& recording) {
  ReplayOptions options;
  const auto length = std::chrono::duration<double>(recording.length()).count();
  if (!(arguments.speed > 0) || !(length / arguments.speed < longest_replay) || !(arguments.tolerance >= 0))
    return problem(wrong_call, "--speed and --tolerance are numbers, and a replay takes less than 30 years");
  options.names_points = !arguments.points.empty();
  options.speed = arguments.speed;
  options.loop = arguments.loop;
  options.faults = !arguments.no_faults;
  options.tolerance =
      std::chrono::duration_cast<Nanoseconds>(std::chrono::duration<double>(arguments.tolerance));
  if (!arguments.from.empty()) {
    const auto moment = parse_moment(arguments.from, recording.wall_at_begin());
    if (!moment)
      return problem(wrong_call,
                     fmt::format("--from: '{}' is no time; give one as 2026-11-24T15:00:00Z, or 15:00 of the "
                                 "recording's first day, local time",
                                 arguments.from));
    options.from = *moment - recording.wall_at_begin();
    if (options.from < Nanoseconds(0) || options.from > recording.length())
      return problem(
          wrong_call,
          fmt::format(
              "--from: {} is {}, and the recording lasts from {} to {}; a time without Z is a local one",
              arguments.from, utc_text(*moment), utc_text(recording.wall_at_begin()),
              utc_text(recording.wall_at_begin() + recording.length())));
  }
  const Map& map = recording.map()->map();
  options.compared.assign(map.points.size(), arguments.points.empty());
  for (const std::string& pattern : arguments.points)
    if (!mark_matching(pattern, map.points, options.compared))
      return problem(wrong_call, fmt::format("--points: no point matches '{}'", pattern));
  return options;
}

}  // namespace

tl::expected<int, ReplayError> serve_replay(const Options& options, const MapPtr& map, StderrLog& log) {
  const std::string& path = options.replay.file;
  if (!options.simulated)
    return problem(wrong_call,
                   "--replay plays a recording in place of hardware; add --sim, so that nobody mistakes it");
  std::ifstream text(path);
  if (!text) return problem(ServeError::map_is_wrong, fmt::format("{}: {}", path, std::strerror(errno)));
  const auto recording = Recording::read(text, path, map);
  if (!recording) return problem(ServeError::map_is_wrong, recording.error());
  auto understood = understand(options.replay, *recording);
  if (!understood) return tl::make_unexpected(understood.error());
  for (const std::string& line : recording->left_out()) log.warn(fmt::format("{}: {}", path, line));
  const PlayedMap played = map_to_play(*recording);
  Player player(*recording, played, *std::move(understood));
  const ReadMap files{{}, log.descriptor(), &played.map};
  auto read = read_first(files);
  if (!read) return problem(read.error().reason, read.error().errors);
  log.write(fmt::format("playing {}: {:.0f} s{}, from the first request on", path,
                        std::chrono::duration<double>(recording->length()).count(),
                        recording->is_foreign() ? " of a foreign coupler, without a node's identity" : ""));
  const int status = serve(played.map, std::move(read->settings), options, log, {}, &player);
  if (player.is_broken())
    return problem(ServeError::device_failed,
                   "the process that served has died, and what clients had written with it; play it again");
  const std::uint32_t differences = player.differences();
  if (status != 0) return status;
  if (differences == 0) return 0;
  log.fail(fmt::format("{} difference{} from the recording", differences, differences == 1 ? "" : "s"));
  return 1;
}

}  // namespace coupler::device
