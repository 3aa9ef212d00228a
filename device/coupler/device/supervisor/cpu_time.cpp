// SPDX-License-Identifier: Apache-2.0
#include "coupler/device/supervisor/cpu_time.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <array>
#include <charconv>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace coupler::device {
namespace {

/// Holds what is read of a file, which is more than is needed of either.
using Text = std::array<char, 128>;

Descriptor open_of(const std::string& process, const char* name) {
  const std::string path = "/proc/" + process + "/" + name;
  return Descriptor(::open(path.c_str(), O_RDONLY | O_CLOEXEC));
}

/// Its beginning; empty if there is nothing to be read any more.
std::string_view read(const Descriptor& file, Text& text) {
  const ssize_t size = ::pread(file.get(), text.data(), text.size(), 0);
  return {text.data(), size < 0 ? 0 : static_cast<std::size_t>(size)};
}

struct SchedStat {
  std::uint64_t ran_ns = 0;
  std::uint64_t waited_ns = 0;
  std::uint64_t turns = 0;
};

std::optional<SchedStat> parse_schedstat(std::string_view text) {
  SchedStat stat;
  const char* at = text.data();
  const char* const end = at + text.size();
  for (std::uint64_t* number : {&stat.ran_ns, &stat.waited_ns, &stat.turns}) {
    while (at != end && *at == ' ') ++at;
    const auto [next, error] = std::from_chars(at, end, *number);
    if (error != std::errc()) return std::nullopt;
    at = next;
  }
  return stat;
}

/// The state in "4711 (name) S 1 ..."; a name may hold anything, parentheses too.
char parse_state(std::string_view text) {
  const auto name_end = text.rfind(") ");
  return name_end == std::string_view::npos || name_end + 2 >= text.size() ? '?' : text[name_end + 2];
}

/// A kernel without SCHED_INFO says "0 0 0" of every process, but this one had a turn at least. Another one's
/// zeros may be true: a child that has never run.
bool kernel_counts_waits() {
  Text text;
  const auto stat = parse_schedstat(read(open_of("self", "schedstat"), text));
  return stat && stat->turns > 0;
}

}  // namespace

std::chrono::nanoseconds WaitEstimate::add(const CpuTimes& times, TimePoint now) {
  // A process that runs in one stretch is seen to run at the latest after a tick of the kernel, some ms.
  if (times.ran != last_.ran || times.waited != last_.waited)
    provisional_ = std::chrono::nanoseconds(0);
  else if (times.is_runnable && looked_ != TimePoint())
    provisional_ += now - looked_;
  last_ = times;
  looked_ = now;
  return times.waited + provisional_;
}

CpuWait::CpuWait(pid_t pid) {
  if (!kernel_counts_waits()) return;
  schedstat_ = open_of(std::to_string(pid), "schedstat");
  stat_ = open_of(std::to_string(pid), "stat");
}

std::chrono::nanoseconds CpuWait::sample(TimePoint now) {
  if (!is_counted()) return waited_;
  Text text;
  const auto stat = parse_schedstat(read(schedstat_, text));
  if (!stat) return waited_;  // the process is gone
  const bool is_runnable = parse_state(read(stat_, text)) == 'R';
  using std::chrono::nanoseconds;
  return waited_ = estimate_.add({nanoseconds(stat->ran_ns), nanoseconds(stat->waited_ns), is_runnable}, now);
}

}  // namespace coupler::device
