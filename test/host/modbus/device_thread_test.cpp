// SPDX-License-Identifier: Apache-2.0
// The thread of a device goes on when memory runs out.
#include "coupler/host/core/device_thread.hpp"

#include <gtest/gtest.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <new>
#include <thread>

#include "coupler/host/core/write.hpp"
#include "coupler/host/modbus/tcp_channel.hpp"
#include "test/fakes/map_builder.hpp"
#include "test/host/modbus/listeners.hpp"
#include "test/host/modbus/modbus_server.hpp"

namespace coupler::host {
namespace {

class ThrowingChannel final : public TcpChannel {
 public:
  using TcpChannel::TcpChannel;

  Result<> send(modbus::Bytes pdu) override {
    if (send_throws.exchange(false)) throw std::bad_alloc();
    return TcpChannel::send(pdu);
  }
  Result<> discard_unasked() override {
    if (discard_throws.exchange(false)) throw std::bad_alloc();
    return TcpChannel::discard_unasked();
  }

  std::atomic<bool> send_throws{false};
  std::atomic<bool> discard_throws{false};
};

class Throws : public testing::Test {
 protected:
  Throws() {
    device.want(0, false);  // no request comes but the writes
    device.start();
  }
  ~Throws() override {
    if (peer >= 0) ::close(peer);
  }

  WriteResult::Outcome write() {
    WriteTicket ticket;
    Write write;
    write.listener = &ticket;
    device.write(write);
    return ticket.wait().outcome;
  }
  void write_until_ok() {
    while (write() != WriteResult::Outcome::ok) std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }

  /// Confirms a write (FC 5): it sends the request back.
  bool serve(int socket) {
    std::array<char, 12> request{};
    if (::recv(socket, request.data(), request.size(), MSG_WAITALL) != 12) return false;
    if (peer < 0) peer = ::dup(socket);
    ::send(socket, request.data(), request.size(), MSG_NOSIGNAL);
    return true;
  }
  MapPtr make_map() const {
    fakes::MapBuilder builder;
    builder.many(Table::coils, 0, 1);
    builder.head().connection.address = "localhost";
    builder.head().connection.port = server.port();
    builder.head().connection.timeout = std::chrono::seconds(20);
    return builder.build();
  }

  std::atomic<int> peer{-1};  ///< the server's side of the first connection, a descriptor of the test's own
  test::LoopbackServer server{[this](int socket) { return serve(socket); }};
  MapPtr owned = make_map();
  const Map& map = owned->map();
  std::shared_ptr<ThrowingChannel> channel = std::make_shared<ThrowingChannel>(map.connection);
  Link link{std::make_shared<SharedChannel>(channel), map.connection, map.limits};
  ValueTable values{map};
  DeafSink sink;
  DeviceThread device{map, Verify::off, {}, link, values, sink};
};

TEST_F(Throws, A_write_that_throws_in_another_thread_has_a_result_and_costs_one_connection) {
  write_until_ok();
  channel->send_throws = true;
  EXPECT_NE(write(), WriteResult::Outcome::ok);
  write_until_ok();
  write_until_ok();  // the connection is counted before it
  EXPECT_EQ(device.statistics().connections, 2U);
}

TEST_F(Throws, Bytes_that_cannot_be_handled_end_no_thread) {
  write_until_ok();
  channel->discard_throws = true;
  ASSERT_EQ(::send(peer, "x", 1, MSG_NOSIGNAL), 1);
  while (channel->discard_throws) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  write_until_ok();
}

}  // namespace
}  // namespace coupler::host
