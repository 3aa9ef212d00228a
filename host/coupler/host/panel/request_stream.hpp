// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <httplib.h>

#include <poll.h>

#include <array>
#include <atomic>
#include <cstddef>
#include <string>

#include "coupler/host/core/clock.hpp"

namespace coupler::host {

/// One request and its answer over a socket. httplib's own stream has a limit for each byte, so that a slow
/// client keeps a worker as long as it likes, and one that sends headers without end fills the memory.
class RequestStream : public httplib::Stream {
 public:
  static constexpr std::chrono::seconds timeout{2};               ///< of the request; then of each write
  static constexpr std::size_t largest = std::size_t{20} * 1024;  ///< bytes of a request, with its body

  /// `ending`: once it is true, nothing is waited for.
  RequestStream(socket_t socket, const std::atomic<bool>& ending);

  bool is_readable() const final { return begin_ < end_ || has_more(until_); }
  /// The other end is there and takes more.
  bool is_writable() const final;
  ssize_t read(char* to, std::size_t size) final;
  ssize_t write(const char* from, std::size_t size) final;
  void get_remote_ip_and_port(std::string& ip, int& port) const final;
  void get_local_ip_and_port(std::string& ip, int& port) const final;
  socket_t socket() const final { return socket_; }

 protected:
  /// What there is to read has come.
  virtual bool has_more(Time until) const { return wait(POLLIN, until); }
  /// Some bytes, as soon as there are; 0: the other end has ended it. -1: it has failed, or it is too late.
  virtual ssize_t receive(char* to, std::size_t size, Time until);
  /// Gives the other end some of these bytes, as soon as it takes them. -1: as above.
  virtual ssize_t give(const char* from, std::size_t size, Time until);
  /// The other end has not ended it.
  virtual bool is_there() const;
  /// Events of poll(2). False: none came in time.
  bool wait(short events, Time until) const;

 private:
  const socket_t socket_;
  const std::atomic<bool>& ending_;
  const Time until_ = std::chrono::steady_clock::now() + timeout;
  std::array<char, 4096> buffer_{};
  std::size_t begin_ = 0;  ///< of what is in the buffer
  std::size_t end_ = 0;
  std::size_t received_ = 0;
};

}  // namespace coupler::host
