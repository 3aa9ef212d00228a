// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <pthread.h>

namespace coupler::device {

/// A mutex between the thread that answers clients and ordinary ones. While the former waits for it, whoever
/// holds it runs with the former's priority (--realtime): otherwise it would wait for all programs that are
/// ahead of that one. std::mutex cannot do that.
class UrgentMutex {
 public:
  UrgentMutex() {
    pthread_mutexattr_t attributes;
    ::pthread_mutexattr_init(&attributes);
    ::pthread_mutexattr_setprotocol(&attributes, PTHREAD_PRIO_INHERIT);
    ::pthread_mutex_init(&mutex_, &attributes);
    ::pthread_mutexattr_destroy(&attributes);
  }
  UrgentMutex(const UrgentMutex&) = delete;
  UrgentMutex& operator=(const UrgentMutex&) = delete;
  ~UrgentMutex() { ::pthread_mutex_destroy(&mutex_); }

  void lock() { ::pthread_mutex_lock(&mutex_); }
  void unlock() { ::pthread_mutex_unlock(&mutex_); }

 private:
  pthread_mutex_t mutex_;
};

}  // namespace coupler::device
