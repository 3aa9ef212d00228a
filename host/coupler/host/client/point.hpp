// SPDX-License-Identifier: Apache-2.0
// The members of a generated client. T is as TypedValue says.
#pragma once

#include <array>
#include <functional>
#include <type_traits>
#include <utility>

#include "coupler/codec/value.hpp"
#include "coupler/host/client/session.hpp"
#include "coupler/map/typed_value.hpp"

namespace coupler::client {

/// A value that was read.
template <class T>
struct Reading {
  T value;
  Quality quality;     ///< good, or why the value may not be true any more
  host::Duration age;  ///< since it was read
};

/// A point that can be read.
template <class T>
class Input : public PointHandle {
 public:
  using value_type = T;

  Input(Session& session, std::uint32_t index) : PointHandle(session, index) {}

  /// The last value, without waiting for the network.
  tl::expected<Reading<T>, NoValue> get() const { return typed(sample()); }
  /// The same, after waiting until the point has been read since connect().
  tl::expected<Reading<T>, NoValue> wait(std::chrono::milliseconds at_most) const {
    return typed(first_sample(at_most));
  }
  /// Calls `use(value)` with the first value, with each that differs from the one before, and when there is
  /// one again after there was none; set it before connect() to miss none. It takes the place of the one
  /// before, and an empty one ends the calls. While one is being called by another thread, this waits for its
  /// end: hold no lock that it takes.
  void on_change(std::function<void(const T&)> use) {
    if (!use) return listen({});
    on_stamped_change([use = std::move(use)](const T& value, host::Stamp) { use(value); });
  }
  /// The same with the time at which the value was true: of a node that tells changes that of the change,
  /// otherwise of the reading (docs/time.md).
  void on_stamped_change(std::function<void(const T&, host::Stamp)> use) {
    if (!use) return listen({});
    listen([use = std::move(use), point = &point()](const std::uint16_t* registers, host::Stamp stamp) {
      use(TypedValue<T>::decode(registers, *point), stamp);
    });
  }

 private:
  tl::expected<Reading<T>, NoValue> typed(tl::expected<Sample, NoValue> sample) const {
    return std::move(sample).map([this](Sample&& known) {
      return Reading<T>{TypedValue<T>::decode(known.registers.data(), point()), known.quality, known.age};
    });
  }
};

/// A number of another type than the point's, which may not fit.
template <class T, class U>
constexpr bool is_other_number =
    std::is_arithmetic_v<T>&& std::is_arithmetic_v<U> && !std::is_same_v<T, bool> &&
    !std::is_same_v<T, char> && !std::is_same_v<U, bool> && !std::is_same_v<U, char> && !std::is_same_v<T, U>;

/// A point that can be written. `Base` says whether it can be read, too.
template <class T, class Base>
class Settable : public Base {
 public:
  using Base::Base;

  /// Sends the value to the device. A value that is not valid for the point is refused; the text then says
  /// what is.
  PendingWrite set(const T& value) { return send(value); }
  /// A number of another type, checked: 300 does not fit std::uint8_t, and 1.5 is not an integer.
  template <class U, std::enable_if_t<is_other_number<T, U>, int> = 0>
  PendingWrite set(U value) {
    return send(value);
  }

  /// The value for Session::write_all(), which refuses what set() refuses.
  NewValue to(const T& value) const { return make_new(value); }
  template <class U, std::enable_if_t<is_other_number<T, U>, int> = 0>
  NewValue to(U value) const {
    return make_new(value);
  }

  /// The device has the value from `due` on: at most an hour ahead and not more than a millisecond past. A
  /// node that can does it by its own timer, and gives the point its value from before again after `duration`
  /// if that is not 0; for every other device the client does it, without a duration (docs/driver-writes.md).
  PendingSchedule schedule(const T& value, host::Time due, std::chrono::milliseconds duration = {}) {
    return send_at(value, due, duration);
  }
  template <class U, std::enable_if_t<is_other_number<T, U>, int> = 0>
  PendingSchedule schedule(U value, host::Time due, std::chrono::milliseconds duration = {}) {
    return send_at(value, due, duration);
  }

 private:
  using Registers = std::array<std::uint16_t, modbus::max_read_bits>;

  /// Empty, or why the point cannot have the value.
  std::string encode(const T& value, Registers& registers) const {
    return TypedValue<T>::encode(value, this->point(), registers.data());
  }
  template <class U, std::enable_if_t<is_other_number<T, U>, int> = 0>
  std::string encode(U value, Registers& registers) const {
    if (this->point().scale.present()) return encode(static_cast<T>(value), registers);
    using Wide = std::conditional_t<std::is_floating_point_v<U>, double,
                                    std::conditional_t<std::is_signed_v<U>, std::int64_t, std::uint64_t>>;
    const auto done =
        codec::encode(codec::Value{static_cast<Wide>(value)}, this->point().format, registers.data());
    return done ? std::string() : done.error();
  }

  template <class U>
  PendingWrite send(const U& value) {
    Registers registers{};
    const std::string wrong = encode(value, registers);
    return wrong.empty() ? this->write(registers.data()) : refused(wrong);
  }
  template <class U>
  NewValue make_new(const U& value) const {
    Registers registers{};
    std::string wrong = encode(value, registers);
    return this->new_value(registers.data(), std::move(wrong));
  }
  template <class U>
  PendingSchedule send_at(const U& value, host::Time due, std::chrono::milliseconds duration) {
    Registers registers{};
    const std::string wrong = encode(value, registers);
    return wrong.empty() ? this->write_at(registers.data(), due, duration) : this->refuse_at(wrong);
  }
};

/// The base of a point that can only be written.
class WriteOnly : public PointHandle {
 public:
  WriteOnly(Session& session, std::uint32_t index) : PointHandle(session, index) {}
};

/// A point that can be read and written.
template <class T>
using Output = Settable<T, Input<T>>;

/// A point that can only be written.
template <class T>
class Command : public Settable<T, WriteOnly> {
 public:
  using value_type = T;
  using Settable<T, WriteOnly>::Settable;
};

}  // namespace coupler::client
