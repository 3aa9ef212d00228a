// SPDX-License-Identifier: Apache-2.0
// The checks that a reply has to pass, over Modbus/TCP and RTU.
#include "coupler/host/modbus/multi_unit_transport.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace coupler::host {
namespace {

using modbus::Range;
using modbus::WriteRequest;

/// Brings a reply that a test has made.
class Replying : public MultiUnitTransport {
 public:
  std::vector<std::uint8_t> reply;
  bool comes_late = false;

  Result<> connect() override { return {}; }
  void close() override {}
  void interrupt() override {}
  Result<> select(std::uint8_t, std::chrono::milliseconds) override { return {}; }
  Result<> open(const Event&) override { return {}; }
  void hang_up() override {}
  Woken wait_until(Time) override { return Woken::by_time; }
  void wake() override {}
  Result<> send_pdu(modbus::Bytes pdu) override {
    sent_.assign(pdu.begin(), pdu.end());
    return {};
  }

 protected:
  modbus::Bytes sent() const override { return {sent_.data(), sent_.size()}; }
  Result<modbus::Bytes> receive_reply() override { return modbus::Bytes(reply.data(), reply.size()); }
  bool is_late() const override { return comes_late; }
  std::chrono::milliseconds timeout() const override { return std::chrono::milliseconds(300); }

 private:
  std::vector<std::uint8_t> sent_;
};

struct MultiUnitTransportTest : testing::Test {
  Result<> read() { return transport.read_registers(Table::holding_registers, Range::of(1, 1), &word); }
  template <class E>
  static bool is(const Result<>& result) {
    return !result && std::holds_alternative<E>(result.error());
  }
  Replying transport;
  std::uint16_t word = 0;
};

TEST_F(MultiUnitTransportTest, A_value_that_came_after_its_time_is_not_used) {
  transport.reply = {3, 2, 0, 7};
  ASSERT_TRUE(read());
  EXPECT_EQ(word, 7);
  transport.comes_late = true;
  EXPECT_TRUE(is<Timeout>(read()));
}

TEST_F(MultiUnitTransportTest, A_write_that_is_confirmed_late_was_made) {
  const auto request = WriteRequest::coil(1, true);
  transport.reply.assign(request.pdu().begin(), request.pdu().end());
  transport.comes_late = true;
  ASSERT_TRUE(transport.send(request));
  EXPECT_TRUE(transport.receive());
}

TEST_F(MultiUnitTransportTest, What_does_not_answer_the_request_is_a_bad_frame) {
  for (const auto& wrong : {std::vector<std::uint8_t>{4, 2, 0, 7}, {3, 2, 0}, {3, 4, 0, 7, 0, 8}, {3}}) {
    transport.reply = wrong;
    EXPECT_TRUE(is<BadFrame>(read()));
  }
  EXPECT_EQ(word, 0);
}

TEST_F(MultiUnitTransportTest, What_was_asked_and_what_came_is_shown_of_a_file_too) {
  transport.reply = {0x14, 1, 2};
  const auto read = transport.read_file_record(1, 0, {&word, 1});
  ASSERT_TRUE(is<BadFrame>(read));
  EXPECT_EQ(to_string(read.error()),
            "malformed reply: not the reply to this request; asked 14 07 06 00 01 00 00 00 01, got 14 01 02");
}

TEST_F(MultiUnitTransportTest, An_exception_is_an_error_with_its_code) {
  transport.reply = {0x83, 4};
  const auto refused = read();
  ASSERT_TRUE(is<ExceptionReply>(refused));
  EXPECT_EQ(exception_in(refused.error())->code, modbus::Exception::server_device_failure);
}

}  // namespace
}  // namespace coupler::host
