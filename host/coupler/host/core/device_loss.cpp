// SPDX-License-Identifier: Apache-2.0
// A device loses its connection.
#include <algorithm>
#include <exception>

#include <fmt/format.h>

#include "coupler/base/what_failed.hpp"
#include "coupler/host/core/device.hpp"

namespace coupler::host {
namespace {

/// Listeners are told one after another; no more than this many may throw.
constexpr int most_throwing = 100000;

std::string loss_text(const Map& map, const Error& error, bool was_online) {
  const std::string why = to_string(error);
  if (is_unit_away(error))
    return fmt::format("the gateway cannot reach unit {}: {}; trying again", map.connection.unit, why);
  return was_online ? fmt::format("connection lost: {}; connecting again", why)
                    : fmt::format("not connected: {}; trying again", why);
}

/// Returns the part of an error's text that tells it from others: the ids and bytes of a malformed reply
/// differ each time.
std::string_view kind_of(const Error& error, std::string_view text) {
  return std::holds_alternative<BadFrame>(error) ? text.substr(0, text.find_first_of("0123456789")) : text;
}

/// Calls functions of which none keeps the next from being called.
class Attempts {
 public:
  /// Returns false if it has thrown.
  template <class F>
  bool call(F f) {
    try {
      f();
      return true;
    } catch (...) {
      if (failure_ == nullptr) failure_ = std::current_exception();
      return false;
    }
  }
  /// One that tells many: it goes on behind the one who has thrown.
  template <class F>
  void call_again(F f) {
    for (int i = 0; i < most_throwing && !call(f); ++i) continue;
  }
  /// The first exception; null if there was none.
  const std::exception_ptr& failure() const { return failure_; }

 private:
  std::exception_ptr failure_;
};

}  // namespace

/// Whatever throws meanwhile: all are told, and the error is reported behind them.
void Device::lost(const Error& error) {
  const std::string why = to_string(error);
  const State before = note(is_unit_away(error) ? DeviceEvent::away : DeviceEvent::lost);
  const bool was_online = before == State::online;
  if (listener_.has_heard())
    unheard_waits_ = 0;
  else if (before >= State::verified && listener_.is_active())
    ++unheard_waits_;
  else if (before >= State::verified)
    unheard_waits_ = std::min(unheard_waits_, most_unheard_waits - 1);  // to be tried again, once
  retry_at_ = clock_.now() + backoff_.next();
  answers_identity_.reset();  // it may be another device next time
  if (was_online) identity_suffices_ = link_.replies() > replies_at_connect_;
  Attempts attempts;
  if (state_ == State::closed) attempts.call([&] { link_.close(); });
  attempts.call([&] { listener_.stop(); });
  attempts.call_again([&] { writer_.disconnected(error); });
  attempts.call([&] { watchdog_.disconnected(why); });
  attempts.call_again([&] { scheduler_.disconnected(why); });
  attempts.call([&] { statistics_.offline(why); });
  attempts.call([&] { values_.online(false); });
  if (was_online) attempts.call([&] { sink_.on_online(false); });
  if (ending_) return;
  attempts.call([&] { sink_.on_failure(error); });
  if (const std::string_view kind = kind_of(error, why); was_online || kind != last_error_kind_) {
    const std::string text = loss_text(map_, error, was_online);
    attempts.call([&] { sink_.on_loss(text); });
    if (attempts.call([&] { tell(Level::warning, text); })) last_error_kind_ = kind;
  }
  if (attempts.failure() != nullptr)
    attempts.call([&] {
      sink_.on_report(Level::error, "an error in this program while it told that the device is lost: " +
                                        what_failed(attempts.failure()));
    });
}

}  // namespace coupler::host
