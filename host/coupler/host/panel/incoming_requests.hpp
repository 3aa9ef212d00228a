// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <poll.h>

#include <atomic>
#include <cstddef>
#include <functional>
#include <memory>
#include <mutex>
#include <thread>
#include <vector>

#include "coupler/host/core/wakeup.hpp"
#include "coupler/host/panel/request_stream.hpp"

namespace coupler::host {

/// Connections whose request has not come as a whole yet. One thread gathers them all, so that who says
/// nothing, or little by little, holds up nobody.
class IncomingRequests {
 public:
  using Handler = std::function<void(std::unique_ptr<RequestStream>)>;
  /// The limit of incoming requests. Of more than these the oldest are dropped: an honest request is complete
  /// within milliseconds.
  static constexpr std::size_t most = 256;

  /// `handle`: called in that thread with each request that is complete.
  explicit IncomingRequests(Handler handle);
  IncomingRequests(const IncomingRequests&) = delete;
  IncomingRequests& operator=(const IncomingRequests&) = delete;
  ~IncomingRequests();

  /// In any thread.
  void add(std::unique_ptr<RequestStream> stream);

 private:
  using Streams = std::vector<std::unique_ptr<RequestStream>>;

  void run();
  void wait();
  void gather();

  const Handler handle_;
  Wakeup wakeup_;
  Streams streams_;             ///< the oldest first; of the thread
  std::vector<pollfd> wanted_;  ///< of the thread: wakeup_, and what each of the streams waits for
  std::atomic<bool> ending_{false};
  std::mutex mutex_;
  Streams added_;
  std::thread thread_;  // last: it uses the others
};

}  // namespace coupler::host
