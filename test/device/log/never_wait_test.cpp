// SPDX-License-Identifier: Apache-2.0
// A test of this file that fails may hang: it waits for a reader who does not come.
#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/ioctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <termios.h>
#include <unistd.h>

#include <csignal>
#include <cstdio>
#include <regex>
#include <sstream>
#include <string>
#include <string_view>

#include "coupler/device/log/stderr_log.hpp"
#include "test/device/log/stderr_reader.hpp"

namespace coupler::device {
namespace {

using testing::StartsWith;

/// More than a pipe, a socket or a terminal takes.
constexpr int many = 20000;

constexpr std::string_view said = "a line that nobody reads, of a usual length";

void say_much(Log& log) {
  for (int i = 0; i < many; ++i) log.write(said);
}

/// Those that came, and those that others said are missing. The last one is "it is read again".
int lines_accounted_for(const std::string& text) {
  const std::string whole = "coupler-node: " + std::string(said);
  const std::regex missing("coupler-node: ([0-9]+) lines? (is|are) missing here: stderr was blocked");
  int count = 0;
  std::string line;
  for (std::istringstream lines(text); std::getline(lines, line);) {
    std::smatch match;
    if (line == whole)
      ++count;
    else if (std::regex_match(line, match, missing))
      count += std::stoi(match[1]);
    else
      EXPECT_TRUE(whole.rfind(line, 0) == 0 || lines.peek() == EOF) << "neither whole nor cut: " << line;
  }
  EXPECT_EQ(line, "coupler-node: it is read again");
  return count;
}

/// Writes until nobody reads, reads, and writes one line more.
void expect_the_rest_is_counted(StderrLog& log, const StderrReader& reader) {
  say_much(log);
  std::string all = reader.read();
  EXPECT_LT(all.size(), many * said.size());
  log.write("it is read again");
  all += reader.read();
  EXPECT_EQ(lines_accounted_for(all), many);
}

TEST(NeverWait, A_pipe_that_nobody_reads_takes_what_it_can) {
  const StderrReader reader = StderrReader::of_pipe();
  StderrLog log(nullptr);
  log.never_wait();
  expect_the_rest_is_counted(log, reader);
}

TEST(NeverWait, A_terminal_too) {
  const StderrReader reader = StderrReader::of_terminal();
  StderrLog log(nullptr);
  log.never_wait();
  expect_the_rest_is_counted(log, reader);
}

TEST(NeverWait, A_socket_too) {
  const StderrReader reader = StderrReader::of_socket();
  StderrLog log(nullptr);
  log.never_wait();
  expect_the_rest_is_counted(log, reader);
}

/// As for a user to whom the pipe does not belong.
TEST(NeverWait, A_pipe_that_cannot_be_opened_again_too) {
#ifdef __SANITIZE_ADDRESS__
  GTEST_SKIP() << "UBSan looks into memory through descriptors of its own, and there are none left here";
#endif
  const StderrReader reader = StderrReader::of_pipe();
  rlimit before{};
  ASSERT_EQ(::getrlimit(RLIMIT_NOFILE, &before), 0);
  const rlimit none{0, before.rlim_max};
  ASSERT_EQ(::setrlimit(RLIMIT_NOFILE, &none), 0);
  StderrLog log(nullptr);
  ASSERT_EQ(::setrlimit(RLIMIT_NOFILE, &before), 0);
  log.never_wait();
  expect_the_rest_is_counted(log, reader);
}

TEST(NeverWait, Ctrl_S_on_a_terminal_stops_nothing) {
  const StderrReader reader = StderrReader::of_terminal();
  StderrLog log(nullptr);
  log.never_wait();
  ASSERT_EQ(::tcflow(STDERR_FILENO, TCOOFF), 0);
  log.write("unseen");
  ASSERT_EQ(::tcflow(STDERR_FILENO, TCOON), 0);
  log.write("seen");
  EXPECT_EQ(reader.read(), "coupler-node: 1 line is missing here: stderr was blocked\ncoupler-node: seen\n");
}

/// A shell's "stty tostop": a background job that writes is stopped.
TEST(NeverWait, A_terminal_that_stops_background_jobs_does_not_stop_it) {
  const StderrReader reader = StderrReader::of_terminal();
  const pid_t shell = ::fork();
  if (shell == 0) {
    termios settings{};
    if (::setsid() < 0 || ::ioctl(STDERR_FILENO, TIOCSCTTY, 0) != 0) ::_exit(1);
    ::tcgetattr(STDERR_FILENO, &settings);
    settings.c_lflag |= TOSTOP;
    ::tcsetattr(STDERR_FILENO, TCSANOW, &settings);
    const pid_t job = ::fork();
    if (job == 0) {
      ::setpgid(0, 0);
      StderrLog log(nullptr);
      log.never_wait();
      log.write("from the background");
      ::_exit(0);
    }
    int status = 0;
    ::waitpid(job, &status, WUNTRACED);
    ::kill(job, SIGKILL);
    ::_exit(WIFEXITED(status) ? WEXITSTATUS(status) : 2);
  }
  int status = -1;
  ASSERT_EQ(::waitpid(shell, &status, 0), shell);
  EXPECT_EQ(status, 0);
  EXPECT_EQ(reader.read(), "coupler-node: from the background\n");
}

TEST(NeverWait, Others_who_write_there_may_wait_as_before) {
  const StderrReader reader = StderrReader::of_pipe();
  StderrLog log(nullptr);
  log.never_wait();
  log.write("serving");
  EXPECT_EQ(::fcntl(STDERR_FILENO, F_GETFL) & O_NONBLOCK, 0);
}

TEST(NeverWait, A_file_keeps_what_others_write_between) {
  testing::internal::CaptureStderr();
  StderrLog log(nullptr);
  log.never_wait();
  log.write("one");
  (void)std::fputs("another program\n", stderr);
  log.write("two");
  EXPECT_EQ(testing::internal::GetCapturedStderr(),
            "coupler-node: one\nanother program\ncoupler-node: two\n");
}

TEST(NeverWait, What_a_forked_process_could_not_write_is_told_by_the_other) {
  const StderrReader reader = StderrReader::of_terminal();
  StderrLog log(nullptr);
  log.never_wait();
  ASSERT_EQ(::tcflow(STDERR_FILENO, TCOOFF), 0);
  const pid_t child = ::fork();
  if (child == 0) {
    log.write("unseen");
    log.write("unseen");
    ::_exit(0);
  }
  ASSERT_EQ(::waitpid(child, nullptr, 0), child);
  ASSERT_EQ(::tcflow(STDERR_FILENO, TCOON), 0);
  log.write("seen");
  EXPECT_THAT(reader.read(), StartsWith("coupler-node: 2 lines are missing here"));
}

TEST(NeverWait, Until_it_is_asked_it_waits_as_programs_do) {
  const StderrReader reader = StderrReader::of_pipe();
  const pid_t child = ::fork();
  if (child == 0) {
    StderrLog log(nullptr);
    say_much(log);
    log.write("it is read again");
    ::_exit(0);
  }
  std::string all;
  pid_t ended = 0;
  for (; ended == 0; ended = ::waitpid(child, nullptr, WNOHANG)) all += reader.read();
  all += reader.read();
  ASSERT_EQ(ended, child);
  EXPECT_EQ(lines_accounted_for(all), many);
  EXPECT_EQ(all.find("missing"), std::string::npos);
}

}  // namespace
}  // namespace coupler::device
