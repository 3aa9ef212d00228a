// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <httplib.h>

#include <poll.h>

#include <atomic>
#include <cstddef>
#include <string>

#include "coupler/host/core/clock.hpp"
#include "coupler/host/panel/request_size.hpp"

namespace coupler::host {

/// One request and its answer over a socket. The request is gathered before httplib sees it: httplib's own
/// stream has a limit for each byte, so that a slow client keeps a thread as long as it likes, and one that
/// sends headers without end fills the memory.
class RequestStream : public httplib::Stream {
 public:
  static constexpr std::chrono::seconds timeout{2};  ///< of the request; then of each write of the answer
  static constexpr std::size_t largest_body = 4096;  ///< bytes

  /// The socket is its own. `ending`: once it is true, nothing is waited for.
  RequestStream(socket_t socket, const std::atomic<bool>& ending);
  RequestStream(const RequestStream&) = delete;
  RequestStream& operator=(const RequestStream&) = delete;
  ~RequestStream() override;

  /// Takes what has come of the request, without waiting for more.
  void gather();
  /// It is there as a whole, or too long to become one.
  bool has_request() const { return has_request_; }
  /// Events of poll(2) that gather() is to be called after; 0: nothing more comes.
  short wants() const { return wants_; }
  /// It is given up then.
  Time until() const { return until_; }
  /// Returns whether the data is not encrypted.
  virtual bool is_plain() const { return true; }

  /// Returns whether bytes of the request are left to read.
  bool is_readable() const final { return taken_ < request_.size(); }
  ssize_t read(char* to, std::size_t size) final;
  /// The other end is there and takes more.
  bool is_writable() const final;
  ssize_t write(const char* from, std::size_t size) final;
  /// Only the local address is told: the panel asks for nothing else.
  void get_remote_ip_and_port(std::string& /*ip*/, int& /*port*/) const final {}
  void get_local_ip_and_port(std::string& ip, int& port) const final;
  socket_t socket() const final { return socket_; }

 protected:
  struct Progress {
    ssize_t bytes = 0;  ///< 0: none yet, if `wants` says something; otherwise it has ended, or failed
    short wants = 0;    ///< events of poll(2) after which to try again
  };
  /// Reads what has come, without waiting.
  virtual Progress receive(char* to, std::size_t size);
  /// Some of these bytes, as far as they are taken at once.
  virtual Progress give(const char* from, std::size_t size);
  /// The other end has not ended it.
  virtual bool is_there() const;

 private:
  bool wait(short events, Time until) const;

  const socket_t socket_;
  const std::atomic<bool>& ending_;
  const Time until_ = std::chrono::steady_clock::now() + timeout;
  std::string request_;
  std::size_t size_ = unknown_size;  ///< that it will have
  std::size_t taken_ = 0;            ///< bytes of it that httplib has read
  bool has_request_ = false;
  short wants_ = POLLIN;
};

}  // namespace coupler::host
