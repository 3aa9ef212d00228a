// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <httplib.h>

#include <sys/socket.h>
#include <unistd.h>

#include <netinet/tcp.h>

#include <atomic>
#include <memory>
#include <string>
#include <utility>

#include "coupler/host/panel/page_tls.hpp"
#include "coupler/host/panel/request_stream.hpp"

namespace coupler::host {

/// httplib's server with requests that have an end (request_stream.hpp), one a connection, with TLS or
/// without.
class HttpServer final : public httplib::Server {
 public:
  /// Both outlive it; `tls` is null for HTTP.
  HttpServer(const std::atomic<bool>& ending, const PageTls* tls) : ending_(ending), tls_(tls) {}

  /// While a request is answered, in its thread: whoever has sent it still waits.
  static bool is_asker_there() { return stream_ != nullptr && stream_->is_writable(); }

 private:
  /// ms; a phone that has gone without a word is not taken for a page much longer.
  static constexpr unsigned unheard = 10'000;

  bool process_and_close_socket(socket_t socket) override {
    ::setsockopt(socket, IPPROTO_TCP, TCP_USER_TIMEOUT, &unheard, sizeof unheard);
    const auto stream = stream_of(socket);
    stream_ = stream.get();
    const bool is_answered = process(*stream, 0);
    stream_ = nullptr;
    ::shutdown(socket, SHUT_RDWR);
    ::close(socket);
    return is_answered;
  }

  std::unique_ptr<RequestStream> stream_of(socket_t socket) const {
    return tls_ ? tls_->stream(socket, ending_) : std::make_unique<RequestStream>(socket, ending_);
  }

  /// Thousands of ranges would be copied; a browser needs none.
  static void without_ranges(httplib::Request& request) { request.ranges.clear(); }

  /// Of the two, that which this version of httplib has: 0.11 to 0.14, then 0.15 to 0.18.
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
    std::string remote, local;
    int remote_port = 0, local_port = 0;
    stream.get_remote_ip_and_port(remote, remote_port);
    stream.get_local_ip_and_port(local, local_port);
    bool is_closed = false;
    return this->process_request(stream, remote, remote_port, local, local_port, true, is_closed,
                                 without_ranges);
  }

  inline static thread_local RequestStream* stream_ = nullptr;  ///< of the request that is answered

  const std::atomic<bool>& ending_;
  const PageTls* tls_;
};

}  // namespace coupler::host
