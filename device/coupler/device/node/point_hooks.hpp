// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <pthread.h>
#include <sys/types.h>

#include <array>
#include <atomic>
#include <string>
#include <string_view>
#include <tl/expected.hpp>
#include <utility>
#include <vector>

#include "coupler/device/core/hooks.hpp"
#include "coupler/map/map.hpp"
#include "coupler/map/typed_value.hpp"
#include "coupler/modbus/limits.hpp"

namespace coupler::device {

/// A mutex with priority inheritance, which std::mutex has not: while the thread that answers clients waits
/// for it (--realtime), the ordinary thread that holds it runs with that thread's priority. Otherwise the
/// former would wait for every program that runs ahead of the latter.
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

/// The values that were set of a point since it was put into the image: the last one, and, of bits whose
/// changes are told, the ones before as well, as far as there is room. It is no member of PointHooks, whose
/// names hide those of firmware.
struct NewValues {
  std::vector<std::uint16_t> registers;
  std::uint32_t lost = 0;  ///< changes of bits before the last value for which there was no room
};

/// The part that the generated hooks of every map have in common: the conversion between values and
/// registers, and values that any thread sets.
class PointHooks : public Hooks {
 public:
  void put_new_values(Image& image, Changes& changes) override;
  void allow_setting(Waker* waker) final;
  [[nodiscard]] bool accept(std::uint32_t, const std::uint16_t*) override { return true; }
  [[nodiscard]] std::string_view take_reason() final {
    return std::exchange(has_reason_, false) ? std::string_view(reason_) : std::string_view();
  }
  [[nodiscard]] Span<const WantedOutput> take_wanted_outputs() final;
  [[nodiscard]] bool hears_lines() const noexcept final { return has_input_lines_; }
  [[nodiscard]] bool take_level(std::uint32_t point, bool level, bool is_news) final;

 protected:
  /// The map outlives it.
  explicit PointHooks(const Map& map);

  /// Returns false, for on_POINT to return it, and the log says why the write was refused. It may be called
  /// only in the thread that answers clients.
  bool refuse(std::string_view why) {
    reason_ = why;
    has_reason_ = true;
    return false;
  }

  /// From any thread of the process that serves: an output's line is driven to this level before the next
  /// request is answered, as a client's write would. What was wanted of it before and is not driven yet does
  /// not count. The error says that this is another process.
  tl::expected<void, std::string> drive(std::uint32_t point, bool level);
  /// From any thread: the last known level of a line.
  bool level_of(std::uint32_t point) const { return levels_[point].load(std::memory_order_relaxed); }
  /// An input's line has this level from now on.
  virtual void line_changed(std::uint32_t /*point*/, bool /*level*/) {}

  template <class T>
  T decode(std::uint32_t point, const std::uint16_t* registers) const {
    return TypedValue<T>::decode(registers, map_.points[point]);
  }

  /// The same as they stand on the wire: range(point).count() registers, or bits as 0 or 1.
  void set_registers(std::uint32_t point, const std::uint16_t* registers) { keep(point, registers); }

  /// The same in place of what was set and is not in the image yet.
  void replace_registers(std::uint32_t point, const std::uint16_t* registers);

  /// From any thread of the process that serves: clients read the value from their next request on, and hear
  /// of each value of a bit, one behind the other, if they wait for changes. Of more than sixteen before the
  /// node looks at them they hear of the first fifteen and the last; the others count as lost. The error says
  /// what is wrong with it, or that this is another process.
  template <class T>
  tl::expected<void, std::string> set(std::uint32_t point, const T& value) {
    std::array<std::uint16_t, modbus::max_read_bits> registers{};
    std::string wrong = wrong_process();
    if (!wrong.empty()) return tl::unexpected(std::move(wrong));
    wrong = TypedValue<T>::encode(value, map_.points[point], registers.data());
    if (!wrong.empty()) return tl::unexpected(std::move(wrong));
    keep(point, registers.data());
    return {};
  }

 private:
  void keep(std::uint32_t point, const std::uint16_t* registers);
  std::string wrong_process() const;

  const Map& map_;
  pid_t process_ = 0;       ///< the one that serves
  Waker* waker_ = nullptr;  ///< in it
  UrgentMutex mutex_;
  std::vector<NewValues> set_;         ///< by point
  std::vector<std::uint32_t> points_;  ///< those that are not empty
  std::vector<WantedOutput> wanted_;   ///< outputs to be driven, each once; guarded by mutex_
  std::vector<WantedOutput> taken_;    ///< those that are being driven
  std::atomic<bool> is_any_wanted_{false};
  std::vector<std::atomic<bool>> levels_;  ///< of lines, by point
  bool has_input_lines_;
  std::string reason_;
  bool has_reason_ = false;  ///< that was not taken yet
};

}  // namespace coupler::device
