// SPDX-License-Identifier: Apache-2.0
// The bare timer: as little as can wait for a time. Prints how late it was each time, in ns.
//   coupler_bench_timer COUNT AHEAD_NS
#include <sys/timerfd.h>
#include <unistd.h>

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <ctime>

namespace {

constexpr std::int64_t second = 1'000'000'000;

std::int64_t now() {
  timespec time{};
  ::clock_gettime(CLOCK_MONOTONIC, &time);
  return time.tv_sec * second + time.tv_nsec;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 3) return 2;
  const int timer = ::timerfd_create(CLOCK_MONOTONIC, TFD_CLOEXEC);
  if (timer < 0) return 1;
  for (int left = std::atoi(argv[1]); left > 0; --left) {
    const std::int64_t due = now() + std::atoll(argv[2]);
    itimerspec when{};
    when.it_value = {due / second, due % second};
    std::uint64_t expirations = 0;
    if (::timerfd_settime(timer, TFD_TIMER_ABSTIME, &when, nullptr) != 0 ||
        ::read(timer, &expirations, sizeof expirations) != sizeof expirations)
      return 1;
    std::printf("%lld\n", static_cast<long long>(now() - due));
  }
  return 0;
}
