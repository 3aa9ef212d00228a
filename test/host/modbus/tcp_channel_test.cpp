// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/modbus/make_links.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <functional>
#include <future>
#include <thread>
#include <utility>
#include <vector>

#include "test/host/modbus/modbus_server.hpp"

namespace coupler::host {
namespace {

using modbus::Range;
using modbus::WriteRequest;
using std::chrono::milliseconds;

Connection connection_to(std::uint16_t port, milliseconds timeout = milliseconds(20000)) {
  Connection connection;
  connection.address = "localhost";  // a name, and not only an address, must do
  connection.port = port;
  connection.timeout = timeout;
  return connection;
}

using Adu = std::vector<std::uint8_t>;

/// Answers each request of twelve bytes with what `answer` makes of it.
class Answering {
 public:
  explicit Answering(std::function<Adu(const Adu& query)> answer)
      : server_([answer = std::move(answer)](int fd) {
          Adu query(12);
          if (::recv(fd, query.data(), query.size(), MSG_WAITALL) != 12) return false;
          const Adu reply = answer(query);
          return ::send(fd, reply.data(), reply.size(), MSG_NOSIGNAL) > 0;
        }) {}
  std::uint16_t port() const { return server_.port(); }

 private:
  test::LoopbackServer server_;
};

template <class E>
bool is(const Result<>& result) {
  return !result && std::holds_alternative<E>(result.error());
}

struct TcpChannelTest : testing::Test {
  TcpChannelTest() { EXPECT_TRUE(link.connect()); }
  Result<> write(const WriteRequest& request) {
    if (auto sent = link.send(request); !sent) return sent;
    return link.receive();
  }
  test::ModbusServer server;
  Link link = make_link(connection_to(server.port()));
};

TEST_F(TcpChannelTest, Each_table_is_read_with_its_own_function) {
  server.tables().tab_bits[3] = 1;
  server.tables().tab_input_bits[4] = 1;
  server.tables().tab_input_registers[5] = 500;
  server.tables().tab_registers[6] = 600;
  std::uint16_t bits[2]{};
  std::uint16_t registers[2]{};
  ASSERT_TRUE(link.read(Table::coils, Range::of(2, 2), bits));
  EXPECT_EQ(bits[1], 1);
  ASSERT_TRUE(link.read(Table::discrete_inputs, Range::of(4, 2), bits));
  EXPECT_EQ(bits[0], 1);
  ASSERT_TRUE(link.read(Table::input_registers, Range::of(4, 2), registers));
  EXPECT_EQ(registers[1], 500);
  ASSERT_TRUE(link.read(Table::holding_registers, Range::of(6, 2), registers));
  EXPECT_EQ(registers[0], 600);
}

TEST_F(TcpChannelTest, What_is_written_arrives) {
  const std::uint16_t bits[] = {1, 0, 1};
  const std::uint16_t registers[] = {7, 8, 9};
  ASSERT_TRUE(write(WriteRequest::coil(1, true)));
  ASSERT_TRUE(write(WriteRequest::coils(10, bits)));
  ASSERT_TRUE(write(WriteRequest::register_value(1, 0xBEEF)));
  ASSERT_TRUE(write(WriteRequest::registers(10, registers)));
  EXPECT_EQ(server.tables().tab_bits[1], 1);
  EXPECT_EQ(server.tables().tab_bits[12], 1);
  EXPECT_EQ(server.tables().tab_registers[1], 0xBEEF);
  EXPECT_EQ(server.tables().tab_registers[12], 9);
}

TEST_F(TcpChannelTest, A_mask_write_changes_the_bits_outside_the_and_mask) {
  server.tables().tab_registers[1] = 0x1234;
  ASSERT_TRUE(write(WriteRequest::mask(1, 0xFF00, 0x00AB)));
  EXPECT_EQ(server.tables().tab_registers[1], 0x12AB);
}

TEST_F(TcpChannelTest, An_exception_is_told_with_its_code_and_the_connection_lives) {
  std::uint16_t word = 0;
  const auto read = link.read(Table::holding_registers, Range::of(100, 1), &word);
  ASSERT_TRUE(is<ExceptionReply>(read));
  EXPECT_EQ(exception_in(read.error())->code, modbus::Exception::illegal_data_address);
  EXPECT_TRUE(link.read(Table::holding_registers, Range::of(99, 1), &word));
}

TEST_F(TcpChannelTest, Without_a_connection_a_request_fails) {
  link.close();
  std::uint16_t word = 0;
  EXPECT_TRUE(is<NotConnected>(link.read(Table::holding_registers, Range::of(1, 1), &word)));
  EXPECT_TRUE(is<NotConnected>(link.read_file_record(1, 0, {&word, 1})));
}

TEST_F(TcpChannelTest, What_was_sent_is_answered_while_its_sender_does_other_things) {
  const auto request = WriteRequest::coil(1, true);
  ASSERT_TRUE(link.send(request));
  EXPECT_EQ(link.wait_until(std::chrono::steady_clock::now() + std::chrono::seconds(20)), Woken::by_bytes);
  EXPECT_TRUE(link.receive());
}

TEST_F(TcpChannelTest, A_wait_ends_by_time_or_by_a_call_even_one_that_came_before) {
  const auto now = std::chrono::steady_clock::now();
  EXPECT_EQ(link.wait_until(now + milliseconds(5)), Woken::by_time);
  link.wake();
  EXPECT_EQ(link.wait_until(now + std::chrono::seconds(20)), Woken::by_call);
  EXPECT_EQ(link.wait_until(std::chrono::steady_clock::now() + milliseconds(5)), Woken::by_time);
}

TEST_F(TcpChannelTest, The_beginning_of_time_has_passed_and_its_end_is_far) {
  EXPECT_EQ(link.wait_until(Time::min()), Woken::by_time);
  link.wake();
  EXPECT_EQ(link.wait_until(Time::max()), Woken::by_call);
}

TEST(TcpChannel, A_late_answer_to_an_earlier_write_is_a_bad_frame) {
  const Answering confused([](Adu query) {
    query[1] = static_cast<std::uint8_t>(query[1] - 1);  // the transaction before
    return query;
  });
  Link link = make_link(connection_to(confused.port()));
  ASSERT_TRUE(link.connect());
  const auto request = WriteRequest::coil(1, true);
  ASSERT_TRUE(link.send(request));
  EXPECT_TRUE(is<BadFrame>(link.receive()));
}

TEST(TcpChannel, An_exception_code_that_no_specification_has_is_told) {
  const Answering odd([](const Adu& query) {
    return Adu{query[0], query[1], 0, 0, 0, 3, query[6], std::uint8_t(query[7] | 0x80), 0x60};
  });
  Link link = make_link(connection_to(odd.port()));
  ASSERT_TRUE(link.connect());
  const auto request = WriteRequest::coil(1, true);
  ASSERT_TRUE(link.send(request));
  EXPECT_EQ(exception_in(link.receive().error())->code, static_cast<modbus::Exception>(0x60));
}

TEST(TcpChannel, A_code_that_libmodbus_keeps_to_itself_is_told) {
  const Answering odd([](const Adu& query) {
    return Adu{query[0], query[1], 0, 0, 0, 3, query[6], std::uint8_t(query[7] | 0x80), 0x60};
  });
  Link link = make_link(connection_to(odd.port()));
  ASSERT_TRUE(link.connect());
  std::uint16_t word = 0;
  std::uint16_t bit = 0;
  const auto registers = link.read(Table::input_registers, Range::of(1, 1), &word);
  const auto bits = link.read(Table::discrete_inputs, Range::of(1, 1), &bit);
  EXPECT_EQ(exception_in(registers.error())->code, static_cast<modbus::Exception>(0x60));
  EXPECT_EQ(exception_in(bits.error())->code, static_cast<modbus::Exception>(0x60));
}

TEST(TcpChannel, Nobody_there_is_told_with_host_port_and_cause) {
  const test::LoopbackSocket nobody;
  Link link = make_link(connection_to(nobody.port()));
  const auto connected = link.connect();
  ASSERT_TRUE(is<NotConnected>(connected));
  EXPECT_EQ(to_string(connected.error()),
            "localhost port " + std::to_string(nobody.port()) + ": Connection refused");
}

TEST(TcpChannel, A_unit_that_modbus_does_not_have_is_told) {
  Connection connection = connection_to(1);
  connection.unit = 250;
  Link link = make_link(connection);
  EXPECT_EQ(to_string(link.connect().error()), "unit 250 is reserved; Modbus has units 0 to 247 and 255");
}

TEST(TcpChannel, Silence_is_a_timeout) {
  test::LoopbackServer silent([](int fd) {
    std::uint8_t byte = 0;
    return ::recv(fd, &byte, 1, 0) > 0;
  });
  Link link = make_link(connection_to(silent.port()));
  ASSERT_TRUE(link.connect());
  link.select(1, milliseconds(50));
  std::uint16_t word = 0;
  EXPECT_TRUE(is<Timeout>(link.read(Table::holding_registers, Range::of(1, 1), &word)));
  EXPECT_TRUE(is<Timeout>(link.read_file_record(1, 0, {&word, 1})));
}

TEST(TcpChannel, A_device_that_speaks_TLS_at_this_port_is_named) {
  test::LoopbackServer secure([](int fd) {
    std::uint8_t query[12];
    if (::recv(fd, query, sizeof query, MSG_WAITALL) != sizeof query) return false;
    const std::uint8_t alert[] = {0x15, 3, 3, 0, 2, 2, 70};
    (void)::send(fd, alert, sizeof alert, MSG_NOSIGNAL);
    return false;
  });
  Link link = make_link(connection_to(secure.port()));
  ASSERT_TRUE(link.connect());
  std::uint16_t word = 0;
  const auto read = link.read(Table::holding_registers, Range::of(1, 1), &word);
  ASSERT_FALSE(read);
  EXPECT_THAT(to_string(read.error()), testing::HasSubstr("speaks TLS at this port"));
}

TEST(TcpChannel, A_reply_to_another_request_is_a_bad_frame) {
  const Answering confused([](const Adu&) { return Adu{0xEE, 0xEE, 0, 0, 0, 5, 1, 3, 2, 0, 7}; });
  Link link = make_link(connection_to(confused.port()));
  ASSERT_TRUE(link.connect());
  std::uint16_t word = 0;
  EXPECT_TRUE(is<BadFrame>(link.read(Table::holding_registers, Range::of(1, 1), &word)));
}

TEST(TcpChannel, Without_transaction_ids_requests_have_0_and_silence_ends_the_connection) {
  std::atomic<int> requests{0};
  bool is_late = false;  // a reply to the request for 9, which is sent before that to the next one
  const auto send_word = [](int fd, std::uint8_t word) {
    const Adu reply{0xEE, 0xEE, 0, 0, 0, 5, 1, 3, 2, 0, word};
    ::send(fd, reply.data(), reply.size(), MSG_NOSIGNAL);
  };
  const test::LoopbackServer gateway([&](int fd) {
    Adu query(12);
    if (::recv(fd, query.data(), query.size(), MSG_WAITALL) != 12) {
      is_late = false;
      return false;
    }
    EXPECT_EQ(query[0] + query[1], 0);
    ++requests;
    if (std::exchange(is_late, query[9] == 9)) send_word(fd, 9);
    if (query[9] != 9) send_word(fd, query[9]);
    return true;
  });
  Limits limits;
  limits.transaction_ids = false;
  Link link = make_link(connection_to(gateway.port()), limits);
  ASSERT_TRUE(link.connect());
  EXPECT_FALSE(link.can_wait());
  std::uint16_t word = 0;
  for (const std::uint16_t address : {std::uint16_t{1}, std::uint16_t{2}}) {
    ASSERT_TRUE(link.read(Table::holding_registers, Range::of(address, 1), &word));
    EXPECT_EQ(word, address);
  }
  link.select(1, milliseconds(50));
  EXPECT_TRUE(is<Timeout>(link.read(Table::holding_registers, Range::of(9, 1), &word)));
  link.select(1, milliseconds(20000));
  ASSERT_TRUE(link.read(Table::holding_registers, Range::of(3, 1), &word)) << "over a new connection";
  EXPECT_EQ(word, 3);
  EXPECT_EQ(requests, 4);
}

TEST(TcpChannel, A_reply_whose_header_does_not_fit_is_a_bad_frame) {
  struct Case {
    const char* what;
    std::size_t at;  // of the header
    std::uint8_t value;
  };
  for (const Case& wrong : {Case{"protocol", 3, 1}, Case{"length", 5, 6}, Case{"unit", 6, 9}}) {
    SCOPED_TRACE(wrong.what);
    const Answering sloppy([&wrong](const Adu& query) {
      Adu reply{query[0], query[1], 0, 0, 0, 5, query[6], 3, 2, 0, 7};
      reply[wrong.at] = wrong.value;
      return reply;
    });
    Link link = make_link(connection_to(sloppy.port()));
    ASSERT_TRUE(link.connect());
    std::uint16_t word = 0;
    const auto read = link.read(Table::holding_registers, Range::of(1, 1), &word);
    EXPECT_TRUE(is<BadFrame>(read));
    EXPECT_EQ(word, 0);
  }
}

TEST(TcpChannel, A_confirmation_of_another_value_is_told_with_that_value) {
  const Answering stubborn([](Adu query) {
    query[11] = 9;
    return query;
  });
  Link link = make_link(connection_to(stubborn.port()));
  ASSERT_TRUE(link.connect());
  ASSERT_TRUE(link.send(WriteRequest::register_value(1, 7)));
  const auto confirmed = link.receive();
  ASSERT_TRUE(is<ExceptionReply>(confirmed));
  EXPECT_EQ(exception_in(confirmed.error())->other_value, 9);
}

TEST(TcpChannel, Bytes_that_nobody_asked_for_are_discarded_and_counted) {
  const Answering babbler([](const Adu& query) {
    return Adu{query[0], query[1], 0, 0, 0, 5, query[6], 3, 2, 0, 7, 'a', 'b', 'c'};
  });
  Link link = make_link(connection_to(babbler.port()));
  ASSERT_TRUE(link.connect());
  std::uint16_t word = 0;
  for (const std::uint64_t before : {0U, 3U, 6U}) {
    ASSERT_TRUE(link.read(Table::holding_registers, Range::of(1, 1), &word));
    EXPECT_EQ(word, 7);
    EXPECT_EQ(link.discarded(), before);
  }
}

TEST(TcpChannel, After_an_exception_with_a_wrong_length_the_connection_is_made_anew) {
  std::atomic<int> ended{0};
  test::LoopbackServer sloppy([&ended](int fd) {
    std::uint8_t query[12];
    if (::recv(fd, query, sizeof query, MSG_WAITALL) != sizeof query) {
      ++ended;
      return false;
    }
    const std::uint8_t reply[] = {query[0], query[1], 0, 0, 0, 4, query[6], 0x83, 2};
    return ::send(fd, reply, sizeof reply, MSG_NOSIGNAL) > 0;
  });
  Link link = make_link(connection_to(sloppy.port()));
  ASSERT_TRUE(link.connect());
  std::uint16_t word = 0;
  for (const int before : {0, 1, 2}) {
    EXPECT_TRUE(is<ExceptionReply>(link.read(Table::holding_registers, Range::of(1, 1), &word)));
    EXPECT_GE(ended, before) << "the server takes one connection at a time";
  }
}

TEST(TcpChannel, A_device_that_hangs_up_is_a_transport_failure) {
  test::LoopbackServer rude([](int) { return false; });
  Link link = make_link(connection_to(rude.port()));
  ASSERT_TRUE(link.connect());
  std::uint16_t word = 0;
  EXPECT_TRUE(is<TransportFailure>(link.read(Table::holding_registers, Range::of(1, 1), &word)));
}

TEST(TcpChannel, An_interrupt_ends_a_request_in_progress_and_every_later_connect) {
  std::promise<void> asked;
  test::LoopbackServer silent([&asked](int fd) {
    std::uint8_t query[12];
    if (::recv(fd, query, sizeof query, MSG_WAITALL) != sizeof query) return false;
    asked.set_value();
    return true;
  });
  Link link = make_link(connection_to(silent.port()));
  ASSERT_TRUE(link.connect());
  std::thread interrupter([&] {
    asked.get_future().wait();
    link.interrupt();
  });
  std::uint16_t word = 0;
  const auto read = link.read(Table::holding_registers, Range::of(1, 1), &word);
  EXPECT_FALSE(read || is<Timeout>(read));
  EXPECT_FALSE(link.connect());
  interrupter.join();
}

/// Serves two records, 0x4142 and 0x4344, or an exception.
bool answer_file_request(int fd, bool refuse) {
  std::uint8_t query[16];
  if (::recv(fd, query, sizeof query, MSG_WAITALL) != sizeof query) return false;
  const std::uint8_t data[] = {query[0], query[1], 0, 0,    0,    9,    query[6], 0x14,
                               6,        5,        6, 0x41, 0x42, 0x43, 0x44};
  const std::uint8_t exception[] = {query[0], query[1], 0, 0, 0, 3, query[6], 0x94, 2};
  return refuse ? ::send(fd, exception, sizeof exception, MSG_NOSIGNAL) > 0
                : ::send(fd, data, sizeof data, MSG_NOSIGNAL) > 0;
}

TEST(TcpChannel, A_file_record_is_read) {
  test::LoopbackServer server([](int fd) { return answer_file_request(fd, false); });
  Link link = make_link(connection_to(server.port()));
  ASSERT_TRUE(link.connect());
  std::uint16_t words[2]{};
  ASSERT_TRUE(link.read_file_record(1, 0, words));
  EXPECT_EQ(words[0], 0x4142);
  EXPECT_EQ(words[1], 0x4344);
}

TEST(TcpChannel, A_device_without_files_answers_an_exception) {
  test::LoopbackServer server([](int fd) { return answer_file_request(fd, true); });
  Link link = make_link(connection_to(server.port()));
  ASSERT_TRUE(link.connect());
  std::uint16_t words[2]{};
  EXPECT_TRUE(is<ExceptionReply>(link.read_file_record(1, 0, words)));
}

}  // namespace
}  // namespace coupler::host
