// SPDX-License-Identifier: Apache-2.0
#include "coupler/generate/output.hpp"

#include <gmock/gmock.h>
#include <sys/stat.h>
#include <unistd.h>

#include <fstream>
#include <future>
#include <iterator>

namespace coupler::generate {
namespace {

namespace fs = std::filesystem;

class Output : public ::testing::Test {
 protected:
  Output() {
    std::string pattern = (fs::temp_directory_path() / "coupler-output-XXXXXX").string();
    folder = ::mkdtemp(pattern.data());
  }
  ~Output() override { fs::remove_all(folder); }

  static std::string read(const fs::path& path) {
    std::ifstream in(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
  }

  fs::path folder;
};

TEST_F(Output, A_new_file_is_written) {
  EXPECT_EQ(write_if_changed(folder / "a", "one\n"), Outcome::written);
  EXPECT_EQ(read(folder / "a"), "one\n");
}

TEST_F(Output, Equal_content_leaves_the_file_as_it_is) {
  ASSERT_TRUE(write_if_changed(folder / "a", "one"));
  const auto long_ago = fs::last_write_time(folder / "a") - std::chrono::hours(1);
  fs::last_write_time(folder / "a", long_ago);
  EXPECT_EQ(write_if_changed(folder / "a", "one"), Outcome::unchanged);
  EXPECT_EQ(fs::last_write_time(folder / "a"), long_ago);
}

TEST_F(Output, Other_content_of_the_same_length_replaces_it) {
  ASSERT_TRUE(write_if_changed(folder / "a", "one"));
  EXPECT_EQ(write_if_changed(folder / "a", "two"), Outcome::written);
  EXPECT_EQ(read(folder / "a"), "two");
}

TEST_F(Output, Who_reads_the_old_file_goes_on_reading_it) {
  ASSERT_TRUE(write_if_changed(folder / "a", "one"));
  std::ifstream reader(folder / "a");
  ASSERT_TRUE(write_if_changed(folder / "a", "two"));
  EXPECT_EQ((std::string{std::istreambuf_iterator<char>(reader), {}}), "one");
}

TEST_F(Output, Nothing_else_remains_in_the_folder) {
  ASSERT_TRUE(write_if_changed(folder / "a", "one"));
  ASSERT_TRUE(write_if_changed(folder / "a", "two"));
  EXPECT_EQ(std::distance(fs::directory_iterator(folder), {}), 1);
}

TEST_F(Output, A_symbolic_link_stays_one_and_what_it_leads_to_is_replaced) {
  fs::create_directories(folder / "real" / "deep");
  fs::create_directory(folder / "links");
  // Two links, both relative; the second one passes a folder that is a link itself.
  fs::create_directory_symlink("../real/deep", folder / "links" / "there");
  fs::create_symlink("there/../b", folder / "links" / "a");
  ASSERT_TRUE(write_if_changed(folder / "real" / "b", "one"));
  std::ifstream reader(folder / "real" / "b");
  EXPECT_EQ(write_if_changed(folder / "links" / "a", "two"), Outcome::written);
  EXPECT_TRUE(fs::is_symlink(folder / "links" / "a"));
  EXPECT_EQ(read(folder / "real" / "b"), "two");
  EXPECT_EQ((std::string{std::istreambuf_iterator<char>(reader), {}}), "one") << "not in one step";
  EXPECT_EQ(write_if_changed(folder / "links" / "a", "two"), Outcome::unchanged);
  EXPECT_EQ(std::distance(fs::directory_iterator(folder / "links"), {}), 2);
  EXPECT_EQ(std::distance(fs::directory_iterator(folder / "real"), {}), 2);
}

TEST_F(Output, A_symbolic_link_to_a_file_that_is_missing_makes_it) {
  fs::create_directory(folder / "real");
  fs::create_symlink(folder / "real" / "b", folder / "a");
  EXPECT_EQ(write_if_changed(folder / "a", "one"), Outcome::written);
  EXPECT_TRUE(fs::is_symlink(folder / "a"));
  EXPECT_EQ(read(folder / "real" / "b"), "one");
}

TEST_F(Output, A_pipe_is_written_to_and_stays) {
  ASSERT_EQ(::mkfifo((folder / "pipe").c_str(), 0600), 0);
  fs::create_symlink("pipe", folder / "a");
  auto reader = std::async(std::launch::async, [this] { return read(folder / "pipe"); });
  EXPECT_EQ(write_if_changed(folder / "a", "one"), Outcome::written);
  EXPECT_EQ(reader.get(), "one");
  EXPECT_TRUE(fs::is_fifo(folder / "pipe"));
}

TEST_F(Output, A_file_keeps_its_permissions) {
  ASSERT_TRUE(write_if_changed(folder / "a", "one"));
  fs::permissions(folder / "a", fs::perms::owner_read | fs::perms::owner_write);
  ASSERT_TRUE(write_if_changed(folder / "a", "two"));
  EXPECT_EQ(fs::status(folder / "a").permissions(), fs::perms::owner_read | fs::perms::owner_write);
}

TEST_F(Output, Symbolic_links_in_a_circle_are_an_error) {
  fs::create_symlink("b", folder / "a");
  fs::create_symlink("a", folder / "b");
  const auto written = write_if_changed(folder / "a", "one");
  ASSERT_FALSE(written);
  EXPECT_EQ(written.error(),
            "cannot write " + (folder / "a").string() + ": Too many levels of symbolic links");
}

TEST_F(Output, A_missing_folder_is_named_in_the_error) {
  const auto written = write_if_changed(folder / "missing" / "a", "one");
  ASSERT_FALSE(written);
  EXPECT_EQ(written.error(),
            "cannot write " + (folder / "missing" / "a").string() + ": No such file or directory");
}

TEST_F(Output, A_folder_in_the_way_is_an_error_and_stays) {
  fs::create_directories(folder / "a" / "b");
  EXPECT_FALSE(write_if_changed(folder / "a", "one"));
  EXPECT_TRUE(fs::is_directory(folder / "a" / "b"));
  EXPECT_EQ(std::distance(fs::directory_iterator(folder), {}), 1);
}

}  // namespace
}  // namespace coupler::generate
