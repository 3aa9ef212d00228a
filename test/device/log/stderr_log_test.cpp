// SPDX-License-Identifier: Apache-2.0
#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <string>

#include "coupler/device/log/stderr_log.hpp"

namespace coupler::device {
namespace {

std::string stderr_stream() {
  struct stat now {};
  EXPECT_EQ(::fstat(STDERR_FILENO, &now), 0);
  return std::to_string(now.st_dev) + ":" + std::to_string(now.st_ino);
}

/// What the log says of one event of each kind.
std::string logged(const char* journal_stream, bool is_really = false) {
  testing::internal::CaptureStderr();
  const std::string stream = is_really ? stderr_stream() : "";
  StderrLog log(is_really ? stream.c_str() : journal_stream);
  log.write("serving");
  log.warn("lost");
  log.fail("refused");
  log.tell({Diagnostic::Severity::error, "map.yaml", 3, 7, "wrong", "mend it"});
  return testing::internal::GetCapturedStderr();
}

TEST(StderrLog, People_see_who_speaks_and_diagnostics_as_editors_know_them) {
  const std::string expected =
      "coupler-node: serving\ncoupler-node: lost\ncoupler-node: refused\nmap.yaml:3:7: error: wrong; mend "
      "it\n";
  EXPECT_EQ(logged(nullptr), expected);
  EXPECT_EQ(logged("1:2"), expected) << "a journal that stderr does not lead to";
  EXPECT_EQ(logged("nonsense"), expected);
}

TEST(StderrLog, The_journal_sees_how_important_it_is) {
  EXPECT_EQ(logged(nullptr, true),
            "<6>serving\n<4>lost\n<3>refused\n<3>map.yaml:3:7: error: wrong; mend it\n");
}

TEST(StderrLog, Of_what_clients_cause_again_and_again_it_says_one_line_a_second) {
  using std::chrono::milliseconds;
  testing::internal::CaptureStderr();
  StderrLog log(nullptr);
  const TimePoint begin = TimePoint() + std::chrono::hours(1);
  EXPECT_EQ(log.tick(begin), std::nullopt);
  for (int i = 0; i < 1000; ++i) {
    log.warn_limited("lamp", "lamp failed");
    log.write_limited("lamp", "lamp works again");
  }
  log.warn_limited("watchdog", "expired");
  EXPECT_EQ(log.tick(begin + milliseconds(10)), milliseconds(990));
  log.write("something else");
  EXPECT_EQ(log.tick(begin + milliseconds(1000)), std::nullopt);
  EXPECT_EQ(testing::internal::GetCapturedStderr(),
            "coupler-node: lamp failed\ncoupler-node: expired\ncoupler-node: something else\n"
            "coupler-node: lamp works again (and 1998 more of this kind)\n");
}

TEST(StderrLog, A_line_that_was_held_back_keeps_its_importance) {
  testing::internal::CaptureStderr();
  StderrLog log(stderr_stream().c_str());
  const TimePoint begin = TimePoint() + std::chrono::hours(1);
  log.tick(begin);
  log.write_limited("lamp", "works again");
  log.warn_limited("lamp", "failed");
  log.tick(begin + std::chrono::seconds(1));
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "<6>works again\n<4>failed\n");
}

TEST(StderrLog, Where_nobody_calls_tick_nothing_is_held_back) {
  testing::internal::CaptureStderr();
  StderrLog log(nullptr);
  log.warn_limited("lamp", "failed");
  log.write_limited("lamp", "works again");
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "coupler-node: failed\ncoupler-node: works again\n");
}

TEST(StderrLog, A_terminal_does_not_obey_a_text_of_a_map_or_a_device) {
  testing::internal::CaptureStderr();
  StderrLog log(nullptr);
  log.write("gpiochip0 (\x1B[2J\u009B2J\xFF\u202E) failed");
  log.tell({Diagnostic::Severity::error, "a\nb.yaml", 3, 7, "'\u009B'", "mend it"});
  EXPECT_EQ(testing::internal::GetCapturedStderr(),
            "coupler-node: gpiochip0 (\\x1b[2J\\x9b2J\\xff\\u202e) failed\n"
            "a\\x0ab.yaml:3:7: error: '\\x9b'; mend it\n");
}

TEST(StderrLog, Nobody_who_reads_it_is_no_reason_to_end) {
  const int before = ::dup(STDERR_FILENO);
  const int full = ::open("/dev/full", O_WRONLY | O_CLOEXEC);
  ASSERT_GE(full, 0);
  ::dup2(full, STDERR_FILENO);
  EXPECT_NO_THROW(StderrLog(nullptr).write("serving"));
  ::dup2(before, STDERR_FILENO);
  ::close(before);
  ::close(full);
}

}  // namespace
}  // namespace coupler::device
