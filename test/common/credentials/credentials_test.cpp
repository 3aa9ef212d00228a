// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

#include "coupler/credentials/credentials.hpp"

namespace coupler {
namespace {

namespace fs = std::filesystem;
using testing::AllOf;
using testing::HasSubstr;

class CredentialFilesTest : public testing::Test {
 protected:
  CredentialFilesTest() {
    std::string form = (fs::temp_directory_path() / "credentials-XXXXXX").string();
    folder_ = ::mkdtemp(form.data());
    text_ = folder_.string();
    for (const char* name : {"own.pem", "own.key", "ca.pem"}) write(name, name);
    fs::permissions(folder_ / "own.key", fs::perms::owner_read | fs::perms::owner_write);
  }
  ~CredentialFilesTest() override {
    ::unsetenv("CREDENTIALS_DIRECTORY");
    fs::remove_all(folder_);
  }

  void write(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name) << text;
  }
  void allow(const std::string& name, unsigned mode) const {
    ASSERT_EQ(::chmod((folder_ / name).c_str(), static_cast<mode_t>(mode)), 0);
  }
  tl::expected<Credentials, std::string> read(std::string_view certificate = "own.pem") const {
    return read_credentials({certificate, "own.key", "ca.pem", {}, text_});
  }
  std::string error() const {
    const auto result = read();
    return result ? "" : result.error();
  }

  fs::path folder_;
  std::string text_;
};

TEST_F(CredentialFilesTest, Are_read_from_the_folder_of_the_map) {
  const auto all = read();
  ASSERT_TRUE(all) << all.error();
  EXPECT_EQ(all->certificate, "own.pem");
  EXPECT_EQ(all->key, "own.key");
  EXPECT_EQ(all->ca, "ca.pem");
  EXPECT_EQ(all->revoked, "");
  EXPECT_TRUE(read((folder_ / "own.pem").string()));
}

TEST_F(CredentialFilesTest, One_that_is_missing_is_named) {
  fs::remove(folder_ / "ca.pem");
  EXPECT_THAT(error(), AllOf(HasSubstr("authority"), HasSubstr((folder_ / "ca.pem").string()),
                             HasSubstr("No such file")));
}

TEST_F(CredentialFilesTest, What_is_no_file_or_too_large_is_not_read) {
  fs::remove(folder_ / "ca.pem");
  fs::create_directory(folder_ / "ca.pem");
  EXPECT_THAT(error(), HasSubstr("not a regular file"));
  fs::remove(folder_ / "ca.pem");
  ASSERT_EQ(::mkfifo((folder_ / "ca.pem").c_str(), 0600), 0);
  EXPECT_THAT(error(), HasSubstr("not a regular file")) << "it waits for nobody";
  fs::remove(folder_ / "ca.pem");
  write("ca.pem", std::string((1 << 20) + 1, 'x'));
  EXPECT_THAT(error(), HasSubstr("1 MiB"));
}

TEST_F(CredentialFilesTest, A_key_is_its_owners) {
  for (const auto& [mode, why] :
       {std::pair(0644U, "everybody may read"), std::pair(0602U, "everybody may change"),
        std::pair(0660U, "its group may change")}) {
    allow("own.key", mode);
    EXPECT_THAT(error(), AllOf(HasSubstr(why), HasSubstr("chmod 600"))) << std::oct << mode;
  }
  allow("own.key", 0640);
  EXPECT_EQ(error(), "") << "its group is that of this process";
}

TEST_F(CredentialFilesTest, Root_takes_no_key_that_somebody_else_can_exchange) {
  if (::geteuid() != 0) GTEST_SKIP() << "only root gives a file to somebody else";
  EXPECT_EQ(error(), "");
  ASSERT_EQ(::chown((folder_ / "own.key").c_str(), 54321, static_cast<gid_t>(-1)), 0);
  EXPECT_THAT(error(), AllOf(HasSubstr("belongs to another user"), HasSubstr("chown root")));
}

TEST_F(CredentialFilesTest, A_group_that_is_another_ones_may_not_read_it_but_in_systemds_folder) {
  if (::geteuid() != 0) GTEST_SKIP() << "only root gives a file to another group";
  ASSERT_EQ(::chown((folder_ / "own.key").c_str(), 0, ::getegid() + 1), 0);
  allow("own.key", 0640);
  EXPECT_THAT(error(), HasSubstr("a group that this process is not in"));
  ::setenv("CREDENTIALS_DIRECTORY", text_.c_str(), 1);
  EXPECT_EQ(error(), "");
}

}  // namespace
}  // namespace coupler
