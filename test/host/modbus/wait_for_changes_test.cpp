// SPDX-License-Identifier: Apache-2.0
// Waiting for changes, with other requests behind it, against a server that answers as it is told.
#include <gtest/gtest.h>
#include <sys/socket.h>

#include <atomic>
#include <chrono>
#include <memory>
#include <optional>
#include <thread>
#include <utility>
#include <vector>

#include "coupler/host/core/link.hpp"
#include "coupler/host/modbus/tcp_channel.hpp"
#include "test/host/modbus/modbus_server.hpp"

namespace coupler::host {
namespace {

using modbus::Range;
using modbus::WriteRequest;
using std::chrono::milliseconds;
using Bytes = std::vector<std::uint8_t>;

constexpr milliseconds late(1500);

/// Holds a wait back until another request comes or `answer_waits` is set; answers reads with `bits`.
class ScriptedNode {
 public:
  std::uint16_t port() const { return server_.port(); }
  std::atomic<bool> answer_waits{false};   ///< at once
  std::atomic<bool> swaps_replies{false};  ///< the wait's answer comes second
  std::atomic<bool> refuses_waits{false};
  std::atomic<bool> ends_no_answer{false};  ///< to a wait: its last byte does not come
  std::atomic<bool> drops_reads{false};     ///< and answers the wait before them late
  std::atomic<bool> is_full{false};         ///< no place for scheduled outputs

 private:
  static bool get(int fd, std::uint8_t* to, std::size_t size) {
    return ::recv(fd, to, size, MSG_WAITALL) == static_cast<ssize_t>(size);
  }
  static Bytes adu(const Bytes& header, const Bytes& pdu) {
    Bytes frame(header.begin(), header.begin() + 7);
    frame[4] = 0;
    frame[5] = static_cast<std::uint8_t>(pdu.size() + 1);
    frame.insert(frame.end(), pdu.begin(), pdu.end());
    return frame;
  }
  Bytes wait_answer() const {
    if (refuses_waits) return adu(wait_, {0xC1, 1});
    modbus::ChangesReply reply;
    reply.epoch = 9;
    reply.newest = 4;
    reply.count = 1;
    reply.changes[0] = {2, modbus::Change::Kind::on, 7, modbus::NodeTime(1234)};
    Bytes pdu(modbus::max_pdu_size);
    pdu.resize(modbus::reply_changes(reply, pdu));
    return adu(wait_, pdu);
  }
  Bytes schedule_answer(const Bytes& request) const {
    if (is_full) return adu(request, {0xC2, 6});
    Bytes pdu(modbus::max_pdu_size);
    pdu.resize(modbus::reply_schedule({77, modbus::NodeTime(5), modbus::NodeTime(6)}, pdu));
    return adu(request, pdu);
  }
  /// One request a call.
  bool serve(int fd) {
    Bytes request(7);
    if (!get(fd, request.data(), 7)) {
      wait_.clear();
      return false;
    }
    Bytes pdu(request[5] - std::size_t{1});
    if (!get(fd, pdu.data(), pdu.size())) return false;
    Bytes answer;
    if (pdu[0] == 0x41) {
      wait_ = request;
      if (!answer_waits) return true;
      answer = wait_answer();
      if (ends_no_answer) answer.pop_back();
      wait_.clear();
    } else {
      const Bytes own = pdu[0] == 0x42 ? schedule_answer(request)
                                       : adu(request, pdu[0] < 5 ? Bytes{pdu[0], 1, 1}
                                                                 : Bytes(pdu.begin(), pdu.begin() + 5));
      const Bytes before = wait_.empty() ? Bytes{} : wait_answer();
      if (drops_reads) {
        std::this_thread::sleep_for(late);
        return ::send(fd, before.data(), before.size(), MSG_NOSIGNAL) > 0;
      }
      answer = swaps_replies ? own : before;
      const Bytes& second = swaps_replies ? before : own;
      answer.insert(answer.end(), second.begin(), second.end());
      wait_.clear();
    }
    return ::send(fd, answer.data(), answer.size(), MSG_NOSIGNAL) == static_cast<ssize_t>(answer.size());
  }

  Bytes wait_;  ///< its header, while it is outstanding
  test::LoopbackServer server_{[this](int fd) { return serve(fd); }};  // last: its thread uses the others
};

struct WaitForChangesTest : testing::Test, WaitListener {
  WaitForChangesTest() {
    connection.address = "127.0.0.1";
    connection.port = node.port();
    connection.timeout = milliseconds(20000);
    connect();
  }
  void connect() {
    channel = std::make_shared<TcpChannel>(connection);
    link.emplace(std::make_shared<SharedChannel>(channel), connection, Limits{});
    link->listen(*this);
    ASSERT_TRUE(link->connect());
  }
  void on_wait_answer(const WaitAnswer& answer) override { heard = answer; }
  std::optional<WaitAnswer> take() { return std::exchange(heard, std::nullopt); }
  Result<> wait(std::uint16_t ms = 20000) { return link->send_wait({ms, 9, 3}); }
  void expect_change() {
    const auto answer = take();
    ASSERT_TRUE(answer);
    ASSERT_TRUE(answer->reply);
    EXPECT_EQ(answer->reply->epoch, 9U);
    ASSERT_EQ(answer->reply->count, 1);
    EXPECT_EQ(answer->reply->changes[0].address, 7);
    EXPECT_LE(answer->sent, answer->received);
    EXPECT_FALSE(take()) << "once";
  }

  ScriptedNode node;
  Connection connection;
  std::shared_ptr<TcpChannel> channel;
  std::optional<Link> link;
  std::optional<WaitAnswer> heard;
  std::uint16_t bit = 0;
};

TEST_F(WaitForChangesTest, The_answer_is_received_when_its_bytes_have_come) {
  node.answer_waits = true;
  ASSERT_TRUE(wait());
  const Time far = std::chrono::steady_clock::now() + std::chrono::minutes(1);
  ASSERT_EQ(link->wait_until(far), Woken::by_bytes);
  ASSERT_TRUE(link->receive_wait());
  expect_change();
}

TEST_F(WaitForChangesTest, A_read_behind_it_has_its_answer_second) {
  ASSERT_TRUE(wait());
  ASSERT_TRUE(link->read(Table::discrete_inputs, Range::of(7, 1), &bit));
  EXPECT_EQ(bit, 1);
  expect_change();
  ASSERT_TRUE(link->read(Table::discrete_inputs, Range::of(7, 1), &bit)) << "and one without a wait";
  EXPECT_FALSE(take());
}

TEST_F(WaitForChangesTest, A_write_behind_it_has_its_answer_second) {
  ASSERT_TRUE(wait());
  const auto request = WriteRequest::coil(3, true);
  ASSERT_TRUE(link->send(request));
  ASSERT_TRUE(link->receive());
  expect_change();
}

TEST_F(WaitForChangesTest, A_scheduled_output_behind_it_has_its_answer_second) {
  const std::uint16_t on = 1;
  const auto request = modbus::ScheduleRequest::coils({9, modbus::NodeTime(1000)}, {&on, 1});
  ASSERT_TRUE(wait());
  const auto accepted = link->schedule(request);
  ASSERT_TRUE(accepted);
  EXPECT_EQ(accepted->number, 77);
  expect_change();
  node.is_full = true;
  const auto refused = link->schedule(request);
  ASSERT_FALSE(refused);
  ASSERT_NE(exception_in(refused.error()), nullptr);
  EXPECT_EQ(exception_in(refused.error())->code, modbus::Exception::server_device_busy);
}

TEST_F(WaitForChangesTest, A_reply_that_comes_before_it_is_an_error) {
  node.swaps_replies = true;
  ASSERT_TRUE(wait());
  const auto read = link->read(Table::discrete_inputs, Range::of(7, 1), &bit);
  ASSERT_FALSE(read);
  EXPECT_TRUE(std::holds_alternative<BadFrame>(read.error()));
}

TEST_F(WaitForChangesTest, An_exception_to_it_does_not_concern_the_request_behind) {
  node.refuses_waits = true;
  ASSERT_TRUE(wait());
  ASSERT_TRUE(link->read(Table::discrete_inputs, Range::of(7, 1), &bit));
  const auto answer = take();
  ASSERT_TRUE(answer);
  ASSERT_FALSE(answer->reply);
  EXPECT_NE(exception_in(answer->reply.error()), nullptr);
}

TEST_F(WaitForChangesTest, A_new_connection_awaits_nothing) {
  ASSERT_TRUE(wait());
  ASSERT_TRUE(link->connect());
  ASSERT_TRUE(link->read(Table::discrete_inputs, Range::of(7, 1), &bit));
  EXPECT_FALSE(take());
}

TEST_F(WaitForChangesTest, An_answer_that_does_not_end_is_a_timeout_long_before_the_wait_is_over) {
  node.answer_waits = true;
  node.ends_no_answer = true;
  const Time over = std::chrono::steady_clock::now() + milliseconds(modbus::longest_wait);
  ASSERT_TRUE(wait(modbus::longest_wait));
  ASSERT_EQ(link->wait_until(over), Woken::by_bytes);
  ASSERT_TRUE(channel->select(connection.unit, milliseconds(1)));
  const auto received = link->receive_wait();
  ASSERT_FALSE(received);
  EXPECT_TRUE(std::holds_alternative<Timeout>(received.error()));
  EXPECT_LT(std::chrono::steady_clock::now(), over);
}

TEST_F(WaitForChangesTest, The_answers_to_the_wait_and_to_the_read_have_one_timeout_together) {
  node.drops_reads = true;
  connection.timeout = milliseconds(2000);
  // With two timeouts it is never over in time; with one, if nothing keeps this program waiting.
  bool in_time = false;
  for (int attempt = 0; attempt < 20 && !in_time; ++attempt) {
    connect();
    ASSERT_TRUE(wait());
    const Time over = std::chrono::steady_clock::now() + late + connection.timeout;
    const auto read = link->read(Table::discrete_inputs, Range::of(7, 1), &bit);
    in_time = std::chrono::steady_clock::now() < over;
    ASSERT_FALSE(read);
    EXPECT_TRUE(std::holds_alternative<Timeout>(read.error()));
  }
  EXPECT_TRUE(in_time);
}

TEST_F(WaitForChangesTest, Silence_is_a_timeout) {
  link->select(connection.unit, milliseconds(1));
  ASSERT_TRUE(wait(1));
  const auto received = link->receive_wait();
  ASSERT_FALSE(received);
  EXPECT_TRUE(std::holds_alternative<Timeout>(received.error()));
}

}  // namespace
}  // namespace coupler::host
