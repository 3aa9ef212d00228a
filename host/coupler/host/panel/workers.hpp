// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <condition_variable>
#include <cstddef>
#include <deque>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

namespace coupler::host {

/// Threads for tasks that wait. (httplib's own pool ends the program where one of its threads cannot be had.)
class Workers {
 public:
  /// Throws std::system_error if not all of them can be had.
  explicit Workers(std::size_t number);
  Workers(const Workers&) = delete;
  Workers& operator=(const Workers&) = delete;
  /// After the tasks that wait.
  ~Workers() { end(); }

  /// In any thread. A task must not throw.
  void add(std::function<void()> task);

 private:
  void run();
  void end();

  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<std::function<void()>> tasks_;
  bool ending_ = false;
  std::vector<std::thread> threads_;  // last: they use the others
};

}  // namespace coupler::host
