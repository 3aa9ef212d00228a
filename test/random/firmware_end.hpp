// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <map>
#include <mutex>
#include <optional>

#include "coupler/device/node/point_hooks.hpp"
#include "test/random/values.hpp"

namespace coupler::random {

/// Generated hooks with code behind each of them. Points are indices into Map::points.
class FirmwareEnd {
 public:
  virtual ~FirmwareEnd() = default;
  virtual device::Hooks& hooks() = 0;
  /// Called in serving_began().
  std::function<void()> when_serving;
  /// set_POINT(value); false if it is refused, or no such function is there.
  virtual bool put(std::uint32_t point, const Values& values) = 0;

  /// What on_POINT(value) got last.
  std::optional<Values> last(std::uint32_t point) {
    const std::lock_guard lock(mutex_);
    const auto found = last_.find(point);
    return found == last_.end() ? std::nullopt : std::optional(found->second);
  }

 protected:
  template <class T>
  bool took(std::uint32_t point, const T& value) {
    const std::lock_guard lock(mutex_);
    last_[point] = Elements<T>::values(value);
    return true;
  }

 private:
  std::mutex mutex_;
  std::map<std::uint32_t, Values> last_;
};

/// What a member function takes, as decltype(argument_of(&Hooks::set_speed)).
template <class Class, class Result, class Argument>
Argument argument_of(Result (Class::*)(Argument));

template <class Argument>
std::decay_t<Argument> typed(const Values& values) {
  return Elements<std::decay_t<Argument>>::typed(values.data());
}

}  // namespace coupler::random
