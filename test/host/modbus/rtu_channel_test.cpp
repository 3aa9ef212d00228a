// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/modbus/rtu_channel.hpp"

#include <gmock/gmock.h>

#include <atomic>
#include <future>
#include <thread>

#include "coupler/host/modbus/make_links.hpp"
#include "test/host/modbus/modbus_server.hpp"
#include "test/host/modbus/serial_line.hpp"

namespace coupler::host {
namespace {

using modbus::Range;
using modbus::WriteRequest;
using std::chrono::milliseconds;
using test::Octets;
using test::rtu;
using test::SerialLine;
using ::testing::HasSubstr;

constexpr milliseconds patient{20000};
constexpr milliseconds impatient{100};

/// The register at address N has N × 100; writes are confirmed.
Octets answer(const Octets& request) {
  const std::uint8_t unit = request[0];
  const unsigned value = request[3] * 100U;
  if (request[1] != 3) return {request.begin(), request.begin() + 8};
  return rtu(unit, {3, 2, static_cast<std::uint8_t>(value >> 8U), static_cast<std::uint8_t>(value)});
}

Octets joined(Octets a, const Octets& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

Result<std::uint16_t> read(Link& link, std::uint16_t address) {
  std::uint16_t word = 0;
  if (auto done = link.read(Table::holding_registers, Range::of(address, 1), &word); !done)
    return tl::make_unexpected(done.error());
  return word;
}

template <class E, class T>
bool is(const Result<T>& result) {
  return !result && std::holds_alternative<E>(result.error());
}

/// A link on a line whose units answer with `reply`.
struct OnLine {
  explicit OnLine(SerialLine::Answer reply, milliseconds timeout = patient)
      : line(std::move(reply)),
        channel(std::make_shared<RtuChannel>(line.connection(1, timeout))),
        link(std::make_shared<SharedChannel>(channel), line.connection(1, timeout), {}) {
    const auto connected = link.connect();
    EXPECT_TRUE(connected) << to_string(connected.error());
  }
  SerialLine line;
  std::shared_ptr<RtuChannel> channel;
  Link link;
};

TEST(RtuChannel, A_register_is_read_over_a_serial_line) {
  OnLine on(answer);
  EXPECT_EQ(read(on.link, 7), 700);
}

TEST(RtuChannel, What_is_written_is_confirmed) {
  OnLine on(answer);
  ASSERT_EQ(read(on.link, 7), 700);
  const auto request = WriteRequest::register_value(1, 7);
  ASSERT_TRUE(on.link.send(request));
  EXPECT_TRUE(on.link.receive());
}

TEST(RtuChannel, An_exception_is_one) {
  OnLine on([](const Octets& request) { return rtu(request[0], {0x83, 2}); });
  EXPECT_TRUE(is<ExceptionReply>(read(on.link, 7)));
}

TEST(RtuChannel, Any_pdu_can_be_exchanged) {
  OnLine on([](const Octets& request) { return rtu(request[0], {0x41, 1, 2, 3}); });
  const Octets pdu{0x41, 9, 8, 7, 6, 5};
  const auto reply = on.link.exchange(pdu);
  ASSERT_TRUE(reply);
  EXPECT_THAT(Octets(reply->begin(), reply->end()), testing::ElementsAre(0x41, 1, 2, 3));
}

TEST(RtuChannel, A_line_that_hands_back_what_is_sent_is_read_all_the_same) {
  OnLine on([](const Octets& request) { return joined(request, answer(request)); });
  EXPECT_EQ(read(on.link, 7), 700);
  const auto request = WriteRequest::register_value(1, 7);
  ASSERT_TRUE(on.link.send(request));
  EXPECT_TRUE(on.link.receive());
}

TEST(RtuChannel, The_echo_of_the_first_write_is_not_its_confirmation) {
  const auto write = [](bool answers, milliseconds timeout) {
    OnLine on([=](const Octets& request) { return answers ? joined(request, answer(request)) : request; },
              timeout);
    const auto request = WriteRequest::register_value(1, 7);
    EXPECT_TRUE(on.link.send(request));
    return on.link.receive();
  };
  EXPECT_TRUE(write(true, patient));
  // Where no echo comes in time to the read before, there is none; the line may have been kept waiting.
  milliseconds timeout = impatient;
  while (timeout < patient && !is<Timeout>(write(false, timeout))) timeout *= 10;
  EXPECT_LT(timeout, patient);
}

TEST(RtuChannel, A_unit_that_only_answers_writes_can_be_written) {
  OnLine on([](const Octets& request) { return request[1] == 3 ? Octets() : answer(request); },
            milliseconds(2000));  // for the read that is not answered, and the write that is
  const auto request = WriteRequest::register_value(1, 7);
  ASSERT_TRUE(on.link.send(request));
  EXPECT_TRUE(on.link.receive());
}

TEST(RtuChannel, Noise_and_the_reply_of_another_unit_are_skipped) {
  OnLine on([](const Octets& request) {
    Octets other = answer(request);
    other[0] = 9;
    return joined(joined({0xFF, 0x00, 1, 3}, other), answer(request));
  });
  EXPECT_EQ(read(on.link, 7), 700);
}

TEST(RtuChannel, Silence_is_a_timeout) {
  OnLine on([](const Octets&) { return Octets(); }, impatient);
  EXPECT_TRUE(is<Timeout>(read(on.link, 7)));
}

TEST(RtuChannel, Where_nothing_but_noise_comes_the_settings_are_named) {
  OnLine on([](const Octets&) { return Octets{0xF0, 0xF0, 0xF0}; }, milliseconds(2000));
  const auto value = read(on.link, 7);
  ASSERT_TRUE(is<BadFrame>(value));
  EXPECT_THAT(to_string(value.error()), HasSubstr("parity"));
}

TEST(RtuChannel, The_late_reply_to_a_request_is_not_taken_for_that_to_the_next) {
  constexpr milliseconds timeout(500);
  for (int attempt = 0; attempt < 20; ++attempt) {
    std::atomic<int> requests{0};
    OnLine on([&](const Octets& request) { return ++requests > 1 ? answer(request) : Octets(); }, timeout);
    const auto begun = std::chrono::steady_clock::now();
    ASSERT_TRUE(is<Timeout>(read(on.link, 7)));
    on.link.select(1, patient);
    auto next = std::async(std::launch::async, [&] { return read(on.link, 8); });
    on.line.send(rtu(1, {3, 2, 700 >> 8, 700 & 0xFF}));
    // Until then nothing is sent, and what comes is late. This thread may have been kept waiting for longer.
    const bool is_late = std::chrono::steady_clock::now() < begun + 2 * timeout;
    const auto value = next.get();
    if (!is_late) continue;
    EXPECT_EQ(value, 800);
    return;
  }
  FAIL() << "this program was kept waiting each time";
}

TEST(RtuChannel, A_hang_up_that_was_meant_for_the_unit_before_ends_nothing) {
  OnLine on(answer);
  on.channel->hang_up();
  on.link.select(1, patient);
  EXPECT_EQ(read(on.link, 7), 700);
}

TEST(RtuChannel, The_late_reply_of_another_unit_is_no_noise_and_is_counted) {
  OnLine on([](const Octets&) { return rtu(17, {3, 2, 0, 1}); }, milliseconds(2000));
  EXPECT_TRUE(is<Timeout>(read(on.link, 7)));
  EXPECT_EQ(on.link.discarded(), 7U);
}

TEST(RtuChannel, What_comes_after_its_time_is_counted) {
  for (int attempt = 0; attempt < 20; ++attempt) {
    std::atomic<int> requests{0};
    OnLine on([&](const Octets& request) { return ++requests > 1 ? answer(request) : Octets(); }, impatient);
    const auto begun = std::chrono::steady_clock::now();
    ASSERT_TRUE(is<Timeout>(read(on.link, 7)));
    EXPECT_EQ(on.link.discarded(), 0U);
    on.line.send(rtu(1, {3, 2, 0, 0}));
    const bool is_late = std::chrono::steady_clock::now() < begun + 2 * impatient;  // as above
    on.link.select(1, patient);
    const auto value = read(on.link, 8);
    if (!is_late) continue;
    EXPECT_EQ(value, 800);
    EXPECT_EQ(on.link.discarded(), 7U);
    return;
  }
  FAIL() << "this program was kept waiting each time";
}

TEST(RtuChannel, A_broadcast_is_sent_and_nothing_awaited) {
  std::atomic<int> broadcasts{0};
  OnLine on([&](const Octets& request) {
    broadcasts += request[0] == 0 ? 1 : 0;
    return request[0] == 0 ? Octets() : answer(request);
  });
  on.link.select(0, patient);
  const auto request = WriteRequest::register_value(1, 7);
  ASSERT_TRUE(on.link.send(request));
  EXPECT_TRUE(on.link.receive());
  const auto value = read(on.link, 7);
  ASSERT_FALSE(value);
  EXPECT_THAT(to_string(value.error()), HasSubstr("broadcast"));
  on.link.select(1, patient);
  EXPECT_EQ(read(on.link, 7), 700);
  EXPECT_EQ(broadcasts, 1);
}

TEST(RtuChannel, A_port_that_goes_is_a_lost_connection) {
  OnLine on(answer);
  ASSERT_EQ(read(on.link, 7), 700);
  on.line.unplug();
  const auto value = read(on.link, 7);
  ASSERT_TRUE(is<TransportFailure>(value));
  on.link.close();
  EXPECT_TRUE(is<NotConnected>(on.link.connect()));
}

TEST(RtuChannel, A_request_ends_when_it_is_interrupted) {
  std::promise<void> asked;
  OnLine on([&](const Octets&) {
    asked.set_value();
    return Octets();
  });
  auto value = std::async(std::launch::async, [&] { return read(on.link, 7); });
  asked.get_future().wait();
  on.link.interrupt();
  EXPECT_TRUE(is<NotConnected>(value.get()));
}

TEST(RtuChannel, A_request_ends_when_another_thread_hangs_up_and_the_next_is_made) {
  std::atomic<int> requests{0};
  std::promise<void> asked;
  OnLine on(
      [&](const Octets& request) {
        if (++requests > 1) return answer(request);
        asked.set_value();
        return Octets();
      },
      patient);
  auto value = std::async(std::launch::async, [&] { return read(on.link, 7); });
  asked.get_future().wait();
  on.channel->hang_up();
  EXPECT_TRUE(is<NotConnected>(value.get()));
  on.link.select(2, patient);  // a request to unit 1 would wait until no late reply can come
  EXPECT_EQ(read(on.link, 8), 800);
}

TEST(RtuChannel, A_unit_that_a_serial_line_cannot_have_is_refused) {
  OnLine on(answer);
  for (const int unit : {248, 255}) {
    const auto selected = on.channel->select(static_cast<std::uint8_t>(unit), patient);
    ASSERT_FALSE(selected);
    EXPECT_THAT(to_string(selected.error()), HasSubstr("1 to 247"));
  }
}

TEST(RtuChannel, The_same_frames_go_over_tcp) {
  const test::LoopbackServer gateway([](int fd) {
    Octets request(8);
    if (::recv(fd, request.data(), request.size(), MSG_WAITALL) != 8) return false;
    const Octets reply = answer(request);
    return ::send(fd, reply.data(), reply.size(), MSG_NOSIGNAL) > 0;
  });
  Connection connection;
  connection.address = "localhost";
  connection.port = gateway.port();
  connection.framing = Framing::rtu;
  Link link = make_link(connection);
  ASSERT_TRUE(link.connect());
  EXPECT_EQ(read(link, 7), 700);
}

}  // namespace
}  // namespace coupler::host
