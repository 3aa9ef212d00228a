// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <string>
#include <string_view>

#include "coupler/host/core/clock.hpp"

namespace coupler::host {

/// Pages that have written. A node's watchdog guards what a connection has written for as long as it stays,
/// so that it must end when nobody is left who would see what the outputs do. Not thread-safe.
class Writers {
 public:
  /// A page that says nothing for so long may be a phone that sleeps.
  static constexpr std::chrono::seconds longest_silence{2};
  /// No more counts between two calls of are_gone(): meanwhile this process did not hear, either.
  static constexpr std::chrono::milliseconds longest_turn{500};

  /// `page`: its token.
  void wrote(std::string_view page, Time now) { heard_.insert_or_assign(std::string(page), now); }
  /// It is still there. Nothing, for one that has not written.
  void alive(std::string_view page, Time now);
  void left(std::string_view page);
  /// True once after the last one is gone: the connection is to be made anew. To be called some ten times a
  /// second.
  bool are_gone(Time now);

 private:
  std::map<std::string, Time, std::less<>> heard_;
  Time looked_ = Time::max();
};

}  // namespace coupler::host
