// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/record/record_file.hpp"

#include <fcntl.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <cstdlib>
#include <fstream>
#include <functional>
#include <iterator>
#include <set>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace coupler::host {
namespace {

namespace fs = std::filesystem;
using testing::ElementsAre;
using testing::EndsWith;
using testing::HasSubstr;

/// The least size at which a file is full.
constexpr std::size_t share = 64 << 10;

/// A recording of at least one line, as long as wanted.
std::string recording_of(std::size_t size, char filling = '.') {
  const std::string front = "{\"record\":1,\"x\":\"";
  const std::string back = "\"}\n";
  return front +
         std::string(size > front.size() + back.size() ? size - front.size() - back.size() : 0, filling) +
         back;
}

class RecordFileTest : public testing::Test {
 protected:
  RecordFileTest() {
    std::string form = (fs::temp_directory_path() / "record-XXXXXX").string();
    folder_ = ::mkdtemp(form.data());
  }
  ~RecordFileTest() override { fs::remove_all(folder_); }

  fs::path path(const std::string& name = "press.jsonl") const { return folder_ / name; }
  std::string text_of(const std::string& name = "press.jsonl") const {
    std::ifstream file(path(name));
    return {std::istreambuf_iterator<char>(file), {}};
  }
  void put(const std::string& name, const std::string& text) const { std::ofstream(path(name)) << text; }
  std::set<std::string> names() const {
    std::set<std::string> found;
    for (const auto& entry : fs::directory_iterator(folder_)) found.insert(entry.path().filename().string());
    return found;
  }
  RecordFile open(RecordFile::Limits limits = {}) const {
    auto file = RecordFile::open(path(), limits);
    EXPECT_TRUE(file.has_value()) << file.error();
    return *std::move(file);
  }
  std::string why_not_opened(const std::string& name = "press.jsonl") const {
    const auto file = RecordFile::open(path(name), {});
    return file ? "" : file.error();
  }

  fs::path folder_;
};

/// What the call returns in a process of its own, whose files have at most `size` bytes.
int in_process_with_small_files(rlim_t size, const std::function<int()>& call) {
  const pid_t child = ::fork();
  if (child == 0) {
    (void)std::signal(SIGXFSZ, SIG_IGN);
    const rlimit limit{size, size};
    ::_exit(::setrlimit(RLIMIT_FSIZE, &limit) == 0 ? call() : 99);
  }
  int status = -1;
  EXPECT_EQ(::waitpid(child, &status, 0), child);
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

TEST_F(RecordFileTest, What_is_written_is_there_at_once_and_counted) {
  RecordFile file = open();
  EXPECT_EQ(file.path(), path());
  EXPECT_TRUE(file.begin("head\n"));
  EXPECT_TRUE(file.write("one\n"));
  EXPECT_TRUE(file.write(""));
  EXPECT_EQ(text_of(), "head\none\n");
  EXPECT_EQ(file.written(), 9U);
}

TEST_F(RecordFileTest, A_file_that_has_been_moved_is_written_on) {
  RecordFile file = open();
  EXPECT_TRUE(file.begin("head\n"));
  RecordFile moved(std::move(file));
  EXPECT_EQ(moved.written(), 5U);
  EXPECT_TRUE(moved.write("one\n"));
  EXPECT_EQ(text_of(), "head\none\n");
}

TEST_F(RecordFileTest, A_file_is_for_its_owner_and_his_group) {
  const mode_t before = ::umask(0);
  open();
  ::umask(before);
  struct stat found {};
  ASSERT_EQ(::stat(path().c_str(), &found), 0);
  EXPECT_EQ(found.st_mode & 0777U, 0640U);
}

TEST_F(RecordFileTest, A_recording_that_is_there_becomes_the_last_of_those_before) {
  for (const char* filling : {"a", "b", "c"}) {
    RecordFile file = open();
    EXPECT_TRUE(file.begin(recording_of(100, filling[0])));
  }
  EXPECT_THAT(names(), ElementsAre("press.1.jsonl", "press.2.jsonl", "press.jsonl"));
  EXPECT_EQ(text_of("press.1.jsonl"), recording_of(100, 'a'));
  EXPECT_EQ(text_of("press.2.jsonl"), recording_of(100, 'b'));
  EXPECT_EQ(text_of(), recording_of(100, 'c'));
}

TEST_F(RecordFileTest, The_next_number_is_above_the_highest_one) {
  put("press.9.jsonl", recording_of(100));
  put("press.10.jsonl", recording_of(100));
  put("press.jsonl", recording_of(100, 'x'));
  open();
  EXPECT_EQ(text_of("press.11.jsonl"), recording_of(100, 'x'));
}

TEST_F(RecordFileTest, A_recording_in_CSV_is_one_too) {
  put("press.jsonl", "t,utc,point,value,quality,u\n");
  open();
  EXPECT_EQ(text_of("press.1.jsonl"), "t,utc,point,value,quality,u\n");
}

TEST_F(RecordFileTest, An_empty_file_is_taken_as_it_is) {
  put("press.jsonl", "");
  RecordFile file = open();
  EXPECT_TRUE(file.begin("head\n"));
  EXPECT_THAT(names(), ElementsAre("press.jsonl"));
  EXPECT_EQ(text_of(), "head\n");
}

TEST_F(RecordFileTest, A_file_that_is_no_recording_is_refused_and_stays) {
  put("press.jsonl", "name: press\n");
  EXPECT_THAT(why_not_opened(), EndsWith("/press.jsonl is there, and is no recording; name another file"));
  EXPECT_EQ(text_of(), "name: press\n");
  EXPECT_THAT(names(), ElementsAre("press.jsonl"));
}

TEST_F(RecordFileTest, What_is_no_file_is_refused_and_stays) {
  const int socket = ::socket(AF_UNIX, SOCK_STREAM, 0);
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  ASSERT_LT(path().string().size(), sizeof address.sun_path);
  path().string().copy(address.sun_path, sizeof address.sun_path - 1);
  ASSERT_EQ(::bind(socket, reinterpret_cast<sockaddr*>(&address), sizeof address), 0);
  EXPECT_THAT(why_not_opened(), HasSubstr("/press.jsonl is not a file; name one"));
  EXPECT_THAT(names(), ElementsAre("press.jsonl"));
  ::close(socket);
}

TEST_F(RecordFileTest, A_foreign_file_that_has_the_next_name_stays) {
  put("press.1.jsonl", "notes\n");
  put("press.jsonl", recording_of(100));
  open();
  EXPECT_EQ(text_of("press.1.jsonl"), "notes\n");
  EXPECT_EQ(text_of("press.2.jsonl"), recording_of(100));
}

TEST_F(RecordFileTest, A_folder_is_refused_with_what_to_do) {
  fs::create_directory(path());
  EXPECT_THAT(why_not_opened(), HasSubstr("/press.jsonl is not a file; name one"));
}

TEST_F(RecordFileTest, A_file_that_is_being_written_is_refused_until_that_ends) {
  {
    RecordFile file = open();
    EXPECT_TRUE(file.begin("head\n"));
    EXPECT_TRUE(file.begin(recording_of(100)));
    EXPECT_THAT(why_not_opened(),
                EndsWith("/press.jsonl is being written by another program; name another file"));
    EXPECT_TRUE(file.write("one\n"));
    EXPECT_EQ(text_of(), recording_of(100) + "one\n");
  }
  EXPECT_EQ(why_not_opened(), "");
}

TEST_F(RecordFileTest, Where_no_file_can_be_made_the_reason_is_told) {
  EXPECT_THAT(why_not_opened("no/press.jsonl"), HasSubstr("no/press.jsonl: No such file or directory"));
}

TEST_F(RecordFileTest, A_file_with_its_share_is_full_and_the_next_one_begins) {
  RecordFile small = *RecordFile::open(path("small.jsonl"), {8 * share, false});
  const std::string lines(share - 1, 'x');
  EXPECT_TRUE(small.begin(recording_of(2 * share))) << "what it begins with does not count";
  EXPECT_TRUE(small.write(lines));
  EXPECT_FALSE(small.is_full());
  EXPECT_TRUE(small.write("\n"));
  EXPECT_TRUE(small.is_full());
  EXPECT_TRUE(small.begin("head\n"));
  EXPECT_FALSE(small.is_full());
  EXPECT_EQ(text_of("small.1.jsonl"), recording_of(2 * share) + lines + "\n");
  EXPECT_EQ(text_of("small.jsonl"), "head\n");
  EXPECT_EQ(small.written(), 3 * share + 5);
}

TEST_F(RecordFileTest, A_file_whose_share_is_larger_is_full_later) {
  RecordFile file = open({8 * 2 * share, false});
  EXPECT_TRUE(file.begin(recording_of(100)));
  EXPECT_TRUE(file.write(std::string(2 * share - 1, 'x')));
  EXPECT_FALSE(file.is_full());
  EXPECT_TRUE(file.write("\n"));
  EXPECT_TRUE(file.is_full());
}

TEST_F(RecordFileTest, The_oldest_are_deleted_when_all_are_more_than_is_kept) {
  RecordFile file = open({4 * share, false});
  for (int i = 0; i < 6; ++i) EXPECT_TRUE(file.begin(recording_of(share)));
  EXPECT_THAT(names(), ElementsAre("press.3.jsonl", "press.4.jsonl", "press.5.jsonl", "press.jsonl"));
}

TEST_F(RecordFileTest, What_is_no_recording_of_this_name_is_neither_counted_nor_deleted) {
  const std::set<std::string> others{"press.1.csv",   "press.0.jsonl", "press.one.jsonl", "press.1.2.jsonl",
                                     "other.1.jsonl", "press..jsonl",  "press.-1.jsonl"};
  for (const std::string& name : others) put(name, recording_of(8 * share));
  put("press.7.jsonl", "notes: " + recording_of(8 * share));
  RecordFile file = open({share, false});
  for (int i = 0; i < 3; ++i) EXPECT_TRUE(file.begin(recording_of(share)));
  std::set<std::string> expected = others;
  expected.insert({"press.7.jsonl", "press.jsonl"});
  EXPECT_EQ(names(), expected);
}

TEST_F(RecordFileTest, After_a_write_that_failed_there_are_whole_lines) {
  EXPECT_EQ(
      in_process_with_small_files(100,
                                  [&] {
                                    RecordFile file = open({1 << 20, true});
                                    if (!file.begin("head\n") || !file.write("one\n")) return 1;
                                    const auto failed = file.write(std::string(150, 'x') + '\n');
                                    if (failed || failed.error() != path().string() + ": File too large")
                                      return 2;
                                    if (file.written() != 9) return 3;
                                    return file.write("two\n") ? 0 : 4;
                                  }),
      0);
  EXPECT_EQ(text_of(), "head\none\ntwo\n");
}

TEST_F(RecordFileTest, A_beginning_that_failed_leaves_an_empty_file_that_can_be_begun) {
  EXPECT_EQ(in_process_with_small_files(100,
                                        [&] {
                                          RecordFile file = open();
                                          if (file.begin(std::string(150, 'x') + '\n')) return 1;
                                          return file.begin("head\n") ? 0 : 2;
                                        }),
            0);
  EXPECT_THAT(names(), ElementsAre("press.jsonl"));
  EXPECT_EQ(text_of(), "head\n");
}

TEST_F(RecordFileTest, Where_the_folder_was_away_a_file_is_made_when_it_is_back) {
  RecordFile file = open();
  EXPECT_TRUE(file.begin(recording_of(100)));
  fs::remove_all(folder_);
  EXPECT_FALSE(file.begin("head\n"));
  EXPECT_FALSE(file.write("one\n"));
  fs::create_directory(folder_);
  EXPECT_TRUE(file.begin("head\n"));
  EXPECT_EQ(text_of(), "head\n");
}

TEST(RecordToStandardOutput, Goes_without_files) {
  testing::internal::CaptureStdout();
  {
    RecordFile output = RecordFile::standard_output();
    EXPECT_TRUE(output.begin("head\n"));
    EXPECT_TRUE(output.write("one\n"));
    EXPECT_TRUE(output.begin("head\n"));
    EXPECT_EQ(output.written(), 14U);
  }
  EXPECT_EQ(testing::internal::GetCapturedStdout(), "head\none\nhead\n");
}

TEST(RecordToStandardOutput, Is_never_full) {
  const auto write_much = [] {
    if (::dup2(::open("/dev/null", O_WRONLY | O_CLOEXEC), STDOUT_FILENO) < 0) return 1;
    RecordFile output = RecordFile::standard_output();
    const std::string line(1 << 20, '.');
    while (output.written() < RecordFile::Limits().keep)
      if (!output.write(line) || output.is_full()) return 2;
    return 0;
  };
  EXPECT_EQ(in_process_with_small_files(RLIM_INFINITY, write_much), 0);
}

}  // namespace
}  // namespace coupler::host
