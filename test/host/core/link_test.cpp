// SPDX-License-Identifier: Apache-2.0
// The checks that a reply has to pass, over Modbus/TCP and RTU, and what a link counts and traces.
#include "coupler/host/core/link.hpp"

#include <gmock/gmock.h>

#include <vector>

#include "test/host/core/share.hpp"

namespace coupler::host {
namespace {

using modbus::Range;
using modbus::WriteRequest;

/// Brings a reply that a test has made.
class Replying : public Channel {
 public:
  std::vector<std::uint8_t> reply;
  bool comes_late = false;
  bool trusted = true;
  int opened = 0;

  Result<> open(const Event&) override {
    ++opened;
    return {};
  }
  void close() override {}
  void hang_up() override {}
  Result<> select(std::uint8_t, std::chrono::milliseconds) override { return {}; }
  Result<> send(modbus::Bytes) override { return {}; }
  Result<modbus::Bytes> receive() override { return modbus::Bytes(reply.data(), reply.size()); }
  bool is_late() const override { return comes_late; }
  bool is_trusted() const override { return trusted; }
  Woken wait_until(Time, Wakeup&, const Event&) override { return Woken::by_time; }
};

struct LinkTest : testing::Test {
  LinkTest() { EXPECT_TRUE(link.connect()); }
  Result<> read() { return link.read_registers(Table::holding_registers, Range::of(1, 1), &word); }
  template <class E>
  static bool is(const Result<>& result) {
    return !result && std::holds_alternative<E>(result.error());
  }
  Replying channel;
  Link link{test::share(channel), {}, {}};
  std::uint16_t word = 0;
};

TEST_F(LinkTest, A_value_that_came_after_its_time_is_not_used) {
  channel.reply = {3, 2, 0, 7};
  ASSERT_TRUE(read());
  EXPECT_EQ(word, 7);
  channel.comes_late = true;
  EXPECT_TRUE(is<Timeout>(read()));
}

TEST_F(LinkTest, A_write_that_is_confirmed_late_was_made) {
  const auto request = WriteRequest::coil(1, true);
  channel.reply.assign(request.pdu().begin(), request.pdu().end());
  channel.comes_late = true;
  ASSERT_TRUE(link.send(request));
  EXPECT_TRUE(link.receive());
}

TEST_F(LinkTest, What_does_not_answer_the_request_is_a_bad_frame) {
  for (const auto& wrong : {std::vector<std::uint8_t>{4, 2, 0, 7}, {3, 2, 0}, {3, 4, 0, 7, 0, 8}, {3}}) {
    channel.reply = wrong;
    EXPECT_TRUE(is<BadFrame>(read()));
  }
  EXPECT_EQ(word, 0);
}

TEST_F(LinkTest, What_was_asked_and_what_came_is_shown_of_a_file_too) {
  channel.reply = {0x14, 1, 2};
  const auto read = link.read_file_record(1, 0, {&word, 1});
  ASSERT_TRUE(is<BadFrame>(read));
  EXPECT_EQ(to_string(read.error()),
            "malformed reply: not the reply to this request; asked 14 07 06 00 01 00 00 00 01, got 14 01 02");
}

TEST_F(LinkTest, An_exception_is_an_error_with_its_code) {
  channel.reply = {0x83, 4};
  const auto refused = read();
  ASSERT_TRUE(is<ExceptionReply>(refused));
  EXPECT_EQ(exception_in(refused.error())->code, modbus::Exception::server_device_failure);
}

TEST_F(LinkTest, Requests_are_counted_by_how_they_end) {
  channel.reply = {3, 2, 0, 7};
  ASSERT_TRUE(read());
  channel.comes_late = true;
  EXPECT_FALSE(read());
  channel.reply = {0x83, 2};
  EXPECT_FALSE(read());
  channel.reply = {4, 2, 0, 7};
  EXPECT_FALSE(read());
  const RequestCounts counts = link.counts();
  EXPECT_EQ(counts.requests, 4U);
  EXPECT_EQ(counts.timeouts, 1U);
  EXPECT_EQ(counts.exceptions[2], 1U);
  EXPECT_EQ(counts.failures, 1U);
  EXPECT_EQ(counts.latency.count(), 2U);
  EXPECT_EQ(link.replies(), 2U);
}

TEST_F(LinkTest, A_trace_says_what_was_asked_and_how_it_ended) {
  std::vector<std::string> lines;
  bool is_wanted = true;
  link.trace({[&] { return is_wanted; }, [&](const std::string& line) { lines.push_back(line); }});
  channel.reply = {3, 2, 0, 7};
  ASSERT_TRUE(read());
  channel.reply = {0x86, 2};
  ASSERT_TRUE(link.send(WriteRequest::register_value(1, 7)));
  EXPECT_FALSE(link.receive());
  is_wanted = false;
  EXPECT_FALSE(read());
  ASSERT_EQ(lines.size(), 2U);
  EXPECT_THAT(lines[0], testing::MatchesRegex("read holding_registers 1 to 1: ok after [0-9.]+ ms"));
  EXPECT_THAT(lines[1], testing::MatchesRegex("write by FC 6 at 1: 00 07: exception 02 .* after [0-9.]+ ms"));
}

TEST_F(LinkTest, A_channel_that_is_not_to_be_trusted_is_opened_anew) {
  channel.reply = {3, 2, 0, 7};
  ASSERT_TRUE(read());
  ASSERT_TRUE(read());
  EXPECT_EQ(channel.opened, 1);
  channel.trusted = false;
  ASSERT_TRUE(read());
  EXPECT_EQ(channel.opened, 1) << "for the next request, not before";
  ASSERT_TRUE(read());
  EXPECT_EQ(channel.opened, 2);
}

}  // namespace
}  // namespace coupler::host
