// SPDX-License-Identifier: Apache-2.0
#include "coupler/device/replay/replay_time.hpp"

#include <cstdlib>
#include <ctime>
#include <string_view>

namespace coupler::device {
namespace {

using std::chrono::nanoseconds;

/// Reads what follows the seconds: ".5", and the end, or "Z".
std::optional<nanoseconds> fraction_of(std::string_view rest) {
  if (rest.empty()) return nanoseconds(0);
  if (rest[0] != '.' || rest.find_first_not_of("0123456789", 1) != std::string_view::npos || rest.size() < 2)
    return std::nullopt;
  const double fraction = std::strtod(std::string(rest).c_str(), nullptr);
  return std::chrono::duration_cast<nanoseconds>(std::chrono::duration<double>(fraction));
}

nanoseconds since_1970(std::tm parts, bool is_utc) {
  parts.tm_isdst = -1;
  return std::chrono::seconds(is_utc ? ::timegm(&parts) : std::mktime(&parts));
}

}  // namespace

std::optional<nanoseconds> parse_moment(const std::string& text, nanoseconds first) {
  const bool is_utc = !text.empty() && text.back() == 'Z';
  const std::string local = text.substr(0, text.size() - (is_utc ? 1 : 0));
  const auto first_second = static_cast<std::time_t>(std::chrono::floor<std::chrono::seconds>(first).count());
  for (const char* const format : {"%Y-%m-%dT%H:%M:%S", "%Y-%m-%dT%H:%M", "%H:%M:%S", "%H:%M"}) {
    std::tm parts{};
    if (is_utc)
      ::gmtime_r(&first_second, &parts);
    else
      ::localtime_r(&first_second, &parts);
    parts.tm_sec = 0;
    const char* const end = ::strptime(local.c_str(), format, &parts);
    if (end == nullptr) continue;
    if (const auto fraction = fraction_of(end)) return since_1970(parts, is_utc) + *fraction;
  }
  return std::nullopt;
}

}  // namespace coupler::device
