// SPDX-License-Identifier: Apache-2.0
// The checks that a reply has to pass, over Modbus/TCP and RTU, and what a link does with its channel, counts
// and traces.
#include "coupler/host/core/link.hpp"

#include <gmock/gmock.h>

#include <functional>
#include <memory>
#include <new>
#include <string>
#include <vector>

#include "test/host/core/fake_clock.hpp"
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
  bool is_bus_line = false;
  bool fails_to_send = false;
  std::function<void()> meanwhile;  ///< while a reply is awaited
  int opened = 0;
  int closed = 0;

  Result<> open(const Event&) override {
    ++opened;
    return {};
  }
  void close() override { ++closed; }
  void hang_up() override {}
  Result<> select(std::uint8_t, std::chrono::milliseconds) override { return {}; }
  Result<> send(modbus::Bytes) override {
    return fails_to_send ? fail(TransportFailure{"gone"}) : Result<>{};
  }
  Result<modbus::Bytes> receive() override {
    if (meanwhile) meanwhile();
    return modbus::Bytes(reply.data(), reply.size());
  }
  bool is_bus() const override { return is_bus_line; }
  bool is_late() const override { return comes_late; }
  bool is_trusted() const override { return trusted; }
};

struct LinkTest : testing::Test {
  LinkTest() { EXPECT_TRUE(link.connect()); }
  Result<> read() { return link.read(Table::holding_registers, Range::of(1, 1), &word); }
  template <class E>
  static bool is(const Result<>& result) {
    return !result && std::holds_alternative<E>(result.error());
  }
  Replying channel;
  test::FakeClock clock;
  std::shared_ptr<SharedChannel> shared = test::share(channel);
  Link link{shared, {}, {}, &clock};
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

TEST_F(LinkTest, A_request_that_throws_keeps_no_turn) {
  channel.reply = {3, 2, 0, 7};
  channel.meanwhile = [] { throw std::bad_alloc(); };
  EXPECT_THROW(read(), std::bad_alloc);
  channel.meanwhile = nullptr;
  link.close();
  ASSERT_TRUE(link.connect());
  EXPECT_TRUE(read());
}

TEST_F(LinkTest, Once_it_is_closed_it_awaits_no_reply_and_takes_no_turn_from_others) {
  ASSERT_TRUE(link.send(WriteRequest::register_value(1, 7)));
  link.close();
  ASSERT_TRUE(shared->turns.try_take(this));
  EXPECT_TRUE(is<NotConnected>(link.receive()));
  EXPECT_TRUE(shared->turns.is_held_by(this));
}

TEST_F(LinkTest, A_failed_write_of_another_thread_leaves_the_channel_to_its_owner) {
  channel.fails_to_send = true;
  const auto request = WriteRequest::coil(1, true);
  ASSERT_TRUE(link.reserve());
  const int before = channel.closed;
  EXPECT_FALSE(link.send(request));  // the owner may poll it at this moment
  EXPECT_EQ(channel.closed, before);
  EXPECT_FALSE(link.send(request));
  EXPECT_EQ(channel.closed, before + 1);
}

TEST_F(LinkTest, A_free_turn_is_taken_though_the_owner_was_woken) {
  link.wake();
  EXPECT_EQ(link.await_turn(Time::max()), Link::Turn::read);
}

TEST_F(LinkTest, On_a_bus_only_the_unit_that_was_silent_is_left_alone_for_a_timeout) {
  channel.is_bus_line = true;
  link.select(1, std::chrono::milliseconds(500));
  channel.comes_late = true;
  channel.reply = {3, 2, 0, 7};
  ASSERT_TRUE(is<Timeout>(read()));
  const Time before = clock.now();
  link.close();
  link.select(2, std::chrono::milliseconds(500));
  ASSERT_TRUE(link.connect());
  EXPECT_EQ(clock.now(), before);
  ASSERT_TRUE(is<Timeout>(read()));
  ASSERT_TRUE(link.connect());
  EXPECT_EQ(clock.now(), before + std::chrono::milliseconds(500));
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
