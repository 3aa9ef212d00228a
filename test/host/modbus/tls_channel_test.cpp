// SPDX-License-Identifier: Apache-2.0
// A device with TLS, which the link talks to as to any.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <future>
#include <string>

#include "coupler/host/modbus/make_links.hpp"
#include "test/host/modbus/tls_front.hpp"

namespace coupler::host {
namespace {

namespace fs = std::filesystem;
using modbus::Range;
using std::chrono::milliseconds;
using testing::AllOf;
using testing::HasSubstr;

class TlsChannelTest : public testing::Test {
 protected:
  TlsChannelTest() {
    std::string form = (fs::temp_directory_path() / "tls-XXXXXX").string();
    folder_ = ::mkdtemp(form.data());
    write(tls::credentials_of(tls::test_client()));
  }
  ~TlsChannelTest() override { fs::remove_all(folder_); }

  /// Writes the client's files.
  void write(const Credentials& credentials) const {
    for (const auto& [name, text] :
         {std::pair("own.pem", &credentials.certificate), std::pair("own.key", &credentials.key),
          std::pair("ca.pem", &credentials.ca)})
      std::ofstream(folder_ / name) << *text;
    ASSERT_EQ(::chmod((folder_ / "own.key").c_str(), 0600), 0);
  }
  Connection connection() const {
    Connection to;
    to.address = "127.0.0.1";
    to.port = front_.port();
    to.timeout = milliseconds(20000);
    to.tls = {"own.pem", "own.key", "ca.pem", "press", {}, text_};
    return to;
  }
  static std::string text(const Result<>& result) { return result ? "" : to_string(result.error()); }

  test::ModbusServer server_;
  test::TlsFront front_{server_.port(), tls::credentials_of(tls::test_node())};
  fs::path folder_;
  const std::string& text_ = folder_.native();
};

TEST_F(TlsChannelTest, Reads_and_writes_as_without_it) {
  Link link = make_link(connection());
  ASSERT_EQ(text(link.connect()), "");
  server_.tables().tab_registers[6] = 600;
  std::uint16_t registers[2]{};
  ASSERT_EQ(text(link.read(Table::holding_registers, Range::of(6, 2), registers)), "");
  EXPECT_EQ(registers[0], 600);
  const std::uint16_t values[] = {7, 8};
  const auto write = modbus::WriteRequest::registers(20, values);
  ASSERT_EQ(text(link.send(write)), "");
  ASSERT_EQ(text(link.receive()), "");
  EXPECT_EQ(server_.tables().tab_registers[21], 8);
}

TEST_F(TlsChannelTest, Connects_again_with_the_files_that_are_there_then) {
  const tls::Pem other = tls::make_authority("other").value();
  write(tls::credentials_of(tls::test_client(), other));
  Link link = make_link(connection());
  std::uint16_t value = 0;
  // With TLS 1.3 the server refuses after this side's handshake.
  std::string problem = text(link.connect());
  if (problem.empty()) problem = text(link.read(Table::holding_registers, Range::of(0, 1), &value));
  EXPECT_THAT(problem, AllOf(HasSubstr("unknown_ca"), HasSubstr("authority")));
  write(tls::credentials_of(tls::test_client()));
  ASSERT_EQ(text(link.connect()), "");
  EXPECT_EQ(text(link.read(Table::holding_registers, Range::of(0, 1), &value)), "");
}

TEST_F(TlsChannelTest, A_device_that_is_not_believed_is_asked_for_nothing) {
  Connection to = connection();
  to.tls.name = "lathe";
  EXPECT_THAT(text(make_link(to).connect()), HasSubstr("another name or address"));
  to = connection();
  fs::remove(folder_ / "own.key");
  EXPECT_THAT(text(make_link(to).connect()), HasSubstr("No such file"));
}

TEST_F(TlsChannelTest, One_without_TLS_says_so) {
  Connection to = connection();
  to.port = server_.port();
  to.timeout = milliseconds(300);
  EXPECT_NE(text(make_link(to).connect()), "");
}

TEST_F(TlsChannelTest, A_device_that_hangs_up_ends_the_request_in_progress) {
  Link link = make_link(connection());
  ASSERT_EQ(text(link.connect()), "");
  auto waiting = std::async(std::launch::async, [&] { return link.wait_until(Time::max()); });
  front_.hang_up();
  EXPECT_EQ(waiting.get(), Woken::by_bytes);
  std::uint16_t value = 0;
  EXPECT_NE(text(link.read(Table::holding_registers, Range::of(0, 1), &value)), "");
}

TEST_F(TlsChannelTest, A_message_of_TLS_itself_is_neither_a_reply_nor_an_end) {
  Link link = make_link(connection());
  ASSERT_EQ(text(link.connect()), "");
  std::uint16_t value = 0;
  ASSERT_EQ(text(link.read(Table::holding_registers, Range::of(0, 1), &value)), "");
  front_.update_key();
  EXPECT_EQ(link.wait_until(Time::max()), Woken::by_bytes);
  EXPECT_EQ(text(link.discard_unasked()), "");
  EXPECT_EQ(text(link.read(Table::holding_registers, Range::of(0, 1), &value)), "");
  EXPECT_EQ(link.discarded(), 0U);
}

TEST_F(TlsChannelTest, An_interrupt_ends_whatever_is_in_progress) {
  Link link = make_link(connection());
  ASSERT_EQ(text(link.connect()), "");
  auto waiting = std::async(std::launch::async, [&] { return link.wait_until(Time::max()); });
  link.interrupt();
  waiting.get();
  EXPECT_NE(text(link.connect()), "");
}

}  // namespace
}  // namespace coupler::host
