// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/types.h>

#include <chrono>
#include <functional>
#include <initializer_list>
#include <optional>
#include <string>
#include <tl/expected.hpp>

#include "coupler/base/descriptor.hpp"

namespace coupler::device {

/// A process that this one forked, with its memory and descriptors. Nothing here waits without a deadline: a
/// process in an uninterruptible call of the kernel does not even end when it is killed.
class Child {
 public:
  /// The new process calls `live` and exits with the status that it returns; an exception ends it with
  /// SIGABRT. The error is an errno.
  static tl::expected<Child, int> start(const std::function<int()>& live);
  Child(Child&& other) noexcept;
  Child& operator=(Child&& other) noexcept;
  /// Kills it, unless its end was seen.
  ~Child();

  pid_t pid() const { return pid_; }
  /// Readable once it has ended (pidfd_open(2)).
  int descriptor() const { return descriptor_.get(); }
  void signal(int number) const;
  /// Its status, as waitpid(2) gives it, as soon as it has ended. nullopt: it has not in this time.
  std::optional<int> wait(std::chrono::milliseconds at_most);
  /// The same after SIGKILL.
  std::optional<int> kill();

 private:
  /// The time limit for a child that was killed: the kernel needs time to free its memory.
  static constexpr std::chrono::seconds timeout{1};

  Child(pid_t pid, Descriptor descriptor) : pid_(pid), descriptor_(std::move(descriptor)) {}

  pid_t pid_;  ///< 0: its end was seen
  Descriptor descriptor_;
};

/// "exited with status 1", "was killed by signal 9 (Killed)".
std::string describe_end(int status);
bool ended_well(int status);

/// Ends the process that calls it when its parent does. False: it has ended already.
bool end_with_parent(pid_t parent, int signal);

/// Closes the descriptors of the parent in a child: all but 0 to 2 and those that are kept (-1 is none).
void close_descriptors(std::initializer_list<int> kept);

}  // namespace coupler::device
