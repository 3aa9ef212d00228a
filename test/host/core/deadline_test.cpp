// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <string>
#include <system_error>

#include "coupler/host/core/wakeup.hpp"

namespace coupler::host {
namespace {

using std::chrono::milliseconds;

std::chrono::nanoseconds time_of_test{0};

TEST(Deadline, It_passes_while_the_machine_is_suspended) {
  time_of_test = milliseconds(5);
  const Deadline deadline(milliseconds(200), [] { return time_of_test; });
  EXPECT_EQ(deadline.left(), 200);
  time_of_test += milliseconds(199);
  EXPECT_EQ(deadline.left(), 1);
  EXPECT_FALSE(deadline.has_passed());
  time_of_test += std::chrono::hours(1);  // of sleep
  EXPECT_EQ(deadline.left(), 0);
  EXPECT_TRUE(deadline.has_passed());
}

TEST(Deadline, Its_clock_is_that_of_the_machine_with_the_time_of_sleep) {
  EXPECT_GE(time_since_boot(), std::chrono::steady_clock::now().time_since_epoch());
}

/// While it lives no file descriptor can be had.
struct NoDescriptors {
  rlimit before{};
  NoDescriptors() {
    ::getrlimit(RLIMIT_NOFILE, &before);
    const rlimit none{0, before.rlim_max};
    ::setrlimit(RLIMIT_NOFILE, &none);
  }
  ~NoDescriptors() { ::setrlimit(RLIMIT_NOFILE, &before); }
};

template <class T>
std::string failure_without_descriptors() {
  const NoDescriptors none;
  try {
    const T made;
    return "made";
  } catch (const std::system_error& error) {
    return error.what();
  }
}

TEST(Wakeup, Without_a_file_descriptor_there_is_none_and_no_event_either) {
#ifdef __SANITIZE_ADDRESS__
  GTEST_SKIP() << "the sanitizer itself needs descriptors, to look at the exception";
#endif
  for (const std::string& failure :
       {failure_without_descriptors<Wakeup>(), failure_without_descriptors<Event>()})
    EXPECT_EQ(failure,
              "no file descriptor is left to wake a thread; look at the limit (ulimit -n, LimitNOFILE= of a "
              "service): Too many open files");
}

}  // namespace
}  // namespace coupler::host
