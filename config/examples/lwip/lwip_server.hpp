// SPDX-License-Identifier: Apache-2.0
// A Modbus/TCP server on lwIP's raw API, for the NodeCore of any map. Copy it: a port has its own numbers.
// All of it, and all that the node calls, runs where lwIP's callbacks do: in tcpip_thread, or in the main
// loop of a system without threads.
#pragma once

#include <lwip/tcp.h>

#include <array>
#include <cstddef>
#include <cstdint>

#include "coupler/device/core/server.hpp"
#include "coupler/modbus/frame.hpp"

/// lwIP's clock, as the node takes it. Called at least every 49 days.
coupler::device::TimePoint lwip_now();

class LwipServer {
 public:
  static constexpr std::size_t max_clients =
      4;  ///< one more takes the place of another; at most MEMP_NUM_TCP_PCB - 1
  static constexpr std::chrono::seconds timeout{
      5};  ///< for the rest of a frame, and for a client to take a reply

  /// Both outlive it.
  LwipServer(coupler::device::Server& server, coupler::device::Statistics& statistics)
      : server_(server), statistics_(statistics) {}
  /// On every address of the machine. False: the port is taken, or lwIP has no memory for it.
  bool listen(std::uint16_t port);
  /// Answers clients that wait for changes, if that is due. To be called after each Handler::tick().
  void answer_waiting();

 private:
  struct Client {
    LwipServer* owner = nullptr;
    tcp_pcb* pcb = nullptr;    ///< null: nobody
    pbuf* received = nullptr;  ///< what does not fit into the framer yet; the window stays closed by as much
    coupler::modbus::Framer framer{};
    coupler::device::ClientSession session{};
    std::array<std::uint8_t, 2 * coupler::modbus::max_adu_size>
        reply{};                 ///< and before it the one to a request that waited
    std::size_t reply_size = 0;  ///< 0: none waits for room
    bool ended = false;          ///< it sends no more
    bool has_asked = false;
    coupler::device::TimePoint last_active{};  ///< of its last frame
    coupler::device::TimePoint
        waits_since{};  ///< the rest of a frame, or room for a reply; single bytes do not extend it
  };
  static Client& of(void* argument) { return *static_cast<Client*>(argument); }
  static LwipServer& owner(void* argument) { return *of(argument).owner; }
  static bool waits(const Client& client) { return client.framer.is_partial() || client.reply_size != 0; }

  err_t accept(tcp_pcb* pcb);
  err_t receive(Client& client, pbuf* data);
  err_t work(Client& client);
  err_t check_deadline(Client& client);
  bool send_reply(Client& client);
  bool fill_framer(Client& client);
  Client& free_place();
  static void forget(Client& client);
  static err_t close(Client& client);
  static err_t abort(Client& client);

  coupler::device::Server& server_;
  coupler::device::Statistics& statistics_;
  std::array<Client, max_clients> clients_{};
};
