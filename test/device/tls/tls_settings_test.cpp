// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include "coupler/device/tls_process/tls_settings.hpp"

namespace coupler::device {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

TEST(TlsSettings, Come_through_memory_as_they_are) {
  const Descriptor memory = make_settings_memory();
  ASSERT_TRUE(write_settings(memory.get(),
                             {{"certificate", std::string("k\0y", 3), "ca", ""}, {}, {"operator", ""}}));
  const auto read = read_settings(memory.get());
  ASSERT_TRUE(read);
  EXPECT_EQ(read->credentials.certificate, "certificate");
  EXPECT_EQ(read->credentials.key, std::string("k\0y", 3));
  EXPECT_EQ(read->credentials.ca, "ca");
  EXPECT_EQ(read->credentials.revoked, "");
  EXPECT_THAT(read->allow, IsEmpty());
  EXPECT_THAT(read->roles, ElementsAre("operator", ""));
}

TEST(TlsSettings, That_are_not_complete_are_none) {
  const Descriptor memory = make_settings_memory();
  EXPECT_FALSE(read_settings(memory.get())) << "empty";
  ASSERT_TRUE(
      write_settings(memory.get(), {{"certificate", "key", "ca", "list"}, {"10.0.0.0/8"}, {"operator"}}));
  const off_t size = ::lseek(memory.get(), 0, SEEK_END);
  for (off_t less = size - 1; less > 0; --less) {
    ASSERT_EQ(::ftruncate(memory.get(), less), 0);
    EXPECT_FALSE(read_settings(memory.get())) << less << " of " << size;
  }
}

}  // namespace
}  // namespace coupler::device
