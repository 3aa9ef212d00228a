// SPDX-License-Identifier: Apache-2.0
#include "test/peers/oracle.hpp"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <sys/socket.h>

#include <array>
#include <cstdio>
#include <cstdlib>

#include "coupler/modbus/limits.hpp"

namespace coupler::oracle {
namespace {

/// One whole ADU; empty if none comes in time.
Bytes read_adu(int socket) {
  const timeval patience{120, 0};
  ::setsockopt(socket, SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof patience);
  Bytes adu(6);
  if (::recv(socket, adu.data(), 6, MSG_WAITALL) != 6) return {};
  const std::size_t rest = static_cast<std::size_t>(adu[4] << 8 | adu[5]);
  adu.resize(6 + rest);
  if (::recv(socket, &adu[6], rest, MSG_WAITALL) != static_cast<ssize_t>(rest)) return {};
  return adu;
}

[[noreturn]] void give_up(const char* what) {
  std::perror(what);
  std::exit(3);
}

}  // namespace

std::string Layout::map() const {
  std::string text = "name: oracle\nunit: 1\nmapping:\n";
  const auto table = [&](const char* name, int from, int count, auto point) {
    text += std::string("  ") + name + ":\n";
    for (int address = from; address < from + count; ++address)
      text += "    " + std::string(1, name[0]) + std::to_string(address) + ": " + point(address) + "\n";
  };
  const auto plain = [](int address) { return std::to_string(address); };
  const auto word = [](int address, int initial) {
    return "{address: " + std::to_string(address) + ", type: WORD, initial: " + std::to_string(initial) + "}";
  };
  table("coils", coils, coils_count, plain);
  table("discrete_inputs", discrete_inputs, discrete_inputs_count, [](int address) {
    return "{address: " + std::to_string(address) +
           ", initial: " + (discrete_input(address) ? "on}" : "off}");
  });
  table("input_registers", input_registers, input_registers_count,
        [&](int address) { return word(address, input_register(address)); });
  table("holding_registers", holding_registers, holding_registers_count,
        [&](int address) { return word(address, 0); });
  return text;
}

Oracle::Oracle(const Layout& layout)
    : context_(modbus_new_tcp("127.0.0.1", 0), modbus_free),
      mapping_(modbus_mapping_new_start_address(static_cast<unsigned>(layout.coils),
                                                static_cast<unsigned>(layout.coils_count),
                                                static_cast<unsigned>(layout.discrete_inputs),
                                                static_cast<unsigned>(layout.discrete_inputs_count),
                                                static_cast<unsigned>(layout.holding_registers),
                                                static_cast<unsigned>(layout.holding_registers_count),
                                                static_cast<unsigned>(layout.input_registers),
                                                static_cast<unsigned>(layout.input_registers_count)),
               modbus_mapping_free) {
  for (int i = 0; i < layout.discrete_inputs_count; ++i)
    mapping_->tab_input_bits[i] = Layout::discrete_input(layout.discrete_inputs + i) ? 1 : 0;
  for (int i = 0; i < layout.input_registers_count; ++i)
    mapping_->tab_input_registers[i] = Layout::input_register(layout.input_registers + i);
  std::array<int, 2> ends{};
  if (::socketpair(AF_UNIX, SOCK_STREAM, 0, ends.data()) != 0) give_up("socketpair");
  servers_end_ = Descriptor(ends[0]);
  our_end_ = Descriptor(ends[1]);
  modbus_set_socket(context_.get(), servers_end_.get());
}

Bytes Oracle::ask(const Bytes& request) {
  if (::send(our_end_.get(), request.data(), request.size(), 0) < 0) give_up("send");
  std::array<std::uint8_t, MODBUS_TCP_MAX_ADU_LENGTH> received{};
  const int size = modbus_receive(context_.get(), received.data());
  if (size <= 0 || modbus_reply(context_.get(), received.data(), size, mapping_.get()) < 0)
    give_up("libmodbus");
  return read_adu(our_end_.get());
}

Peer::Peer(std::uint16_t port) : socket_(::socket(AF_INET, SOCK_STREAM, 0)) {
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(port);
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  connected_ = ::connect(socket_.get(), reinterpret_cast<sockaddr*>(&address), sizeof address) == 0;
  const int on = 1;
  ::setsockopt(socket_.get(), IPPROTO_TCP, TCP_NODELAY, &on, sizeof on);
}

Bytes Peer::ask(const Bytes& request) {
  if (::send(socket_.get(), request.data(), request.size(), MSG_NOSIGNAL) < 0) return {};
  return read_adu(socket_.get());
}

}  // namespace coupler::oracle
