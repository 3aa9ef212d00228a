// SPDX-License-Identifier: Apache-2.0
#include "lwip_server.hpp"

#include <lwip/sys.h>

#include <algorithm>
#include <tuple>

using coupler::modbus::Framer;

// lwIP counts milliseconds in 32 bits.
coupler::device::TimePoint lwip_now() {
  static std::uint64_t last = 0;
  last += static_cast<std::uint32_t>(sys_now() - static_cast<std::uint32_t>(last));
  return coupler::device::TimePoint(std::chrono::milliseconds(last));
}

bool LwipServer::listen(std::uint16_t port) {
  tcp_pcb* pcb = tcp_new_ip_type(IPADDR_TYPE_ANY);
  if (pcb == nullptr) return false;
  if (tcp_bind(pcb, IP_ANY_TYPE, port) != ERR_OK) {
    tcp_close(pcb);
    return false;
  }
  tcp_pcb* listener = tcp_listen(pcb);
  if (listener == nullptr) {
    tcp_close(pcb);
    return false;
  }
  tcp_arg(listener, this);
  tcp_accept(listener, [](void* self, tcp_pcb* from, err_t error) -> err_t {
    if (error != ERR_OK || from == nullptr) return ERR_VAL;
    return static_cast<LwipServer*>(self)->accept(from);
  });
  return true;
}

err_t LwipServer::accept(tcp_pcb* pcb) {
  Client& place = free_place();
  place = {};
  place.owner = this;
  place.pcb = pcb;
  place.last_active = lwip_now();
  ++statistics_.connections;
  tcp_nagle_disable(pcb);
  tcp_arg(pcb, &place);
  tcp_recv(pcb,
           [](void* client, tcp_pcb*, pbuf* data, err_t) { return owner(client).receive(of(client), data); });
  tcp_sent(pcb, [](void* client, tcp_pcb*, u16_t) { return owner(client).work(of(client)); });
  tcp_poll(
      pcb, [](void* client, tcp_pcb*) { return owner(client).check_deadline(of(client)); },
      1);                                                         // every half second
  tcp_err(pcb, [](void* client, err_t) { forget(of(client)); });  // lwIP has freed the connection
  return ERR_OK;
}

err_t LwipServer::receive(Client& client, pbuf* data) {
  if (!waits(client)) client.waits_since = lwip_now();
  if (data == nullptr)
    client.ended = true;
  else if (client.received == nullptr)
    client.received = data;
  else
    pbuf_cat(client.received, data);
  return work(client);
}

void LwipServer::answer_waiting() {
  for (Client& client : clients_)
    if (client.pcb != nullptr && client.session.wait) work(client);
}

/// Answers whole frames, and what waits for changes, for as long as there is room for replies.
err_t LwipServer::work(Client& client) {
  while (send_reply(client)) {
    client.reply_size = server_.answer_waiting(client.session, lwip_now(), client.reply);
    if (client.reply_size != 0) continue;
    switch (client.framer.next()) {
      case Framer::Outcome::frame:
        client.last_active = client.waits_since = lwip_now();
        client.has_asked = true;
        client.reply_size =
            server_.answer(client.framer.frame(), client.session, client.last_active, client.reply);
        break;
      case Framer::Outcome::bad: ++statistics_.bad_frames; return close(client);
      case Framer::Outcome::nothing:
        if (fill_framer(client)) break;
        if (!client.ended) return tcp_output(client.pcb);
        client.reply_size = server_.end_wait(client.session, lwip_now(), client.reply);
        if (client.reply_size == 0) return close(client);
    }
  }
  return tcp_output(client.pcb);
}

/// False: a reply waits for room.
bool LwipServer::send_reply(Client& client) {
  if (client.reply_size == 0) return true;
  const auto size = static_cast<u16_t>(client.reply_size);
  if (tcp_sndbuf(client.pcb) < size ||
      tcp_write(client.pcb, client.reply.data(), size, TCP_WRITE_FLAG_COPY) != ERR_OK)
    return false;
  client.reply_size = 0;
  return true;
}

/// False: nothing more was received.
bool LwipServer::fill_framer(Client& client) {
  if (client.received == nullptr) return false;
  const auto room = client.framer.room();
  const auto size = static_cast<u16_t>(std::min<std::size_t>(room.size(), client.received->tot_len));
  pbuf_copy_partial(client.received, room.data(), size, 0);
  client.received = pbuf_free_header(client.received, size);
  client.framer.filled(size);
  tcp_recved(client.pcb, size);
  return true;
}

err_t LwipServer::check_deadline(Client& client) {
  if (!waits(client) || lwip_now() - client.waits_since < timeout) return work(client);
  ++statistics_.timeouts;
  return abort(client);
}

/// The place of nobody; else of one from the address that has the most connections: first of who never asked,
/// then of who never wrote an output, then of who has been idle for longest.
LwipServer::Client& LwipServer::free_place() {
  const auto rank = [this](const Client& client) {
    const auto from_there = std::count_if(clients_.begin(), clients_.end(), [&](const Client& other) {
      return other.pcb != nullptr && ip_addr_cmp(&other.pcb->remote_ip, &client.pcb->remote_ip);
    });
    return std::tuple(-from_there, client.has_asked, client.session.has_written, client.last_active);
  };
  Client* last = nullptr;
  for (Client& client : clients_) {
    if (client.pcb == nullptr) return client;
    if (last == nullptr || rank(client) < rank(*last)) last = &client;
  }
  ++statistics_.evictions;
  abort(*last);
  return *last;
}

void LwipServer::forget(Client& client) {
  client.owner->server_.end_session(client.session, lwip_now());
  if (client.received != nullptr) pbuf_free(client.received);
  client.received = nullptr;
  client.pcb = nullptr;
}

/// Data that was written is still sent, but unless all received data was taken, lwIP would reset the
/// connection.
err_t LwipServer::close(Client& client) {
  tcp_pcb* pcb = client.pcb;
  if (client.received != nullptr) tcp_recved(pcb, client.received->tot_len);
  tcp_output(pcb);
  tcp_arg(pcb, nullptr);
  tcp_recv(pcb, nullptr);
  tcp_sent(pcb, nullptr);
  tcp_err(pcb, nullptr);
  tcp_poll(pcb, nullptr, 0);
  forget(client);
  if (tcp_close(pcb) == ERR_OK) return ERR_OK;
  tcp_abort(pcb);
  return ERR_ABRT;
}

/// To be returned by the callback whose connection it is.
err_t LwipServer::abort(Client& client) {
  tcp_pcb* pcb = client.pcb;
  tcp_err(pcb, nullptr);
  forget(client);
  tcp_abort(pcb);
  return ERR_ABRT;
}
