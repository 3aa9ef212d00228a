// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <httplib.h>

#include <netinet/tcp.h>
#include <sys/socket.h>
#include <unistd.h>

#include <atomic>
#include <cstddef>
#include <functional>
#include <memory>
#include <string>
#include <utility>

#include "coupler/host/panel/incoming_requests.hpp"
#include "coupler/host/panel/page_tls.hpp"
#include "coupler/host/panel/request_stream.hpp"
#include "coupler/host/panel/workers.hpp"

namespace coupler::host {

/// httplib's server with requests that have an end (request_stream.hpp), one a connection, with TLS or
/// without.
class HttpServer final : public httplib::Server {
 public:
  /// `workers`: requests that are answered at a time. The others outlive it; `tls` is null for HTTP.
  HttpServer(std::size_t workers, const std::atomic<bool>& ending, const PageTls* tls)
      : ending_(ending), tls_(tls), workers_(workers) {
    new_task_queue = [] { return new HandsOn; };
  }
  /// httplib leaves the socket open where it was bound only.
  ~HttpServer() override {
    if (const socket_t socket = svr_sock_.exchange(INVALID_SOCKET); socket != INVALID_SOCKET) ::close(socket);
  }
  HttpServer(const HttpServer&) = delete;
  HttpServer& operator=(const HttpServer&) = delete;

  /// Once it is bound: so many connections may wait until they are accepted. Of httplib's five some would be
  /// lost, and made again a second later.
  void set_backlog(int connections) { ::listen(svr_sock_, connections); }

  /// While a request is answered, in its thread: whoever has sent it still waits.
  static bool is_asker_there() { return stream_ != nullptr && stream_->is_writable(); }
  /// Returns whether the request came without TLS, as above.
  static bool is_plain() { return stream_ == nullptr || stream_->is_plain(); }

 private:
  /// ms; a phone that has gone without a word is not taken for a page much longer.
  static constexpr unsigned unheard = 10'000;

  /// In the thread that accepts connections: they are only handed on.
  struct HandsOn : httplib::TaskQueue {
    using Taken = decltype(std::declval<httplib::TaskQueue&>().enqueue({}));  // void until 0.14, then bool
    Taken enqueue(std::function<void()> task) override {
      task();
      return Taken(true);
    }
    void shutdown() override {}
  };

  bool process_and_close_socket(socket_t socket) override {
    ::setsockopt(socket, IPPROTO_TCP, TCP_USER_TIMEOUT, &unheard, sizeof unheard);
    incoming_.add(tls_ ? tls_->stream(socket, ending_) : std::make_unique<RequestStream>(socket, ending_));
    return true;
  }

  void answer(RequestStream& stream) {
    stream_ = &stream;
    process(stream, 0);
    stream_ = nullptr;
  }

  /// Thousands of ranges would be copied; a browser needs none.
  static void without_ranges(httplib::Request& request) { request.ranges.clear(); }

  /// One of these two exists in this version of httplib: 0.11 to 0.14, then 0.15 to 0.18.
  template <class Stream>
  auto process(Stream& stream, int)
      -> decltype(this->process_request(stream, true, std::declval<bool&>(), without_ranges)) {
    bool is_closed = false;
    return this->process_request(stream, true, is_closed, without_ranges);
  }
  template <class Stream>
  auto process(Stream& stream, long)
      -> decltype(this->process_request(stream, std::string(), 0, std::string(), 0, true,
                                        std::declval<bool&>(), without_ranges)) {
    std::string local;
    int port = 0;
    stream.get_local_ip_and_port(local, port);
    bool is_closed = false;
    return this->process_request(stream, std::string(), 0, local, port, true, is_closed, without_ranges);
  }

  inline static thread_local RequestStream* stream_ = nullptr;  ///< of the request that is answered

  const std::atomic<bool>& ending_;
  const PageTls* tls_;
  Workers workers_;
  IncomingRequests incoming_{[this](std::unique_ptr<RequestStream> stream) {
    workers_.add([this, shared = std::shared_ptr(std::move(stream))] { answer(*shared); });
  }};
};

}  // namespace coupler::host
