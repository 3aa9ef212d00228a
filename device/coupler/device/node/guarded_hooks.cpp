// SPDX-License-Identifier: Apache-2.0
#include "coupler/device/node/guarded_hooks.hpp"

#include <fmt/format.h>

#include <exception>

namespace coupler::device {
namespace {

/// Calls `call`; `thrown(what)` if it throws. False if it did.
template <class Call, class Thrown>
bool guard(Call call, Thrown thrown) {
  try {
    call();
    return true;
  } catch (const std::exception& exception) {
    thrown(exception.what());
  } catch (...) {
    thrown("something that is not a std::exception");
  }
  return false;
}

}  // namespace

void GuardedHooks::log(const std::string& who, const char* what) {
  log_.fail(fmt::format("{} threw an exception: {}", who, what));
}

/// Clients ask as often as they like.
void GuardedHooks::log_limited(const std::string& who, const std::string& what) {
  log_.warn_limited("hook", fmt::format("{} threw an exception: {}", who, what));
}

bool GuardedHooks::begin(Waker* waker) {
  hooks_.allow_setting(waker);
  return guard([&] { hooks_.serving_began(); }, [&](const char* what) { log("serving_began()", what); });
}

bool GuardedHooks::end(Image& image) {
  hooks_.allow_setting(nullptr);
  const bool safe = made_safe();
  Changes told_to_nobody;
  hooks_.put_new_values(image, told_to_nobody);
  return safe;
}

bool GuardedHooks::made_safe() {
  return guard([&] { hooks_.make_safe(); }, [&](const char* what) { log("make_safe()", what); });
}

bool GuardedHooks::answers() {
  bool does = true;
  guard([&] { does = hooks_.answers(); }, [&](const char* what) { log_limited("answers()", what); });
  return does;
}

std::optional<modbus::Exception> GuardedHooks::refuse_read(Table table, modbus::Range range) {
  std::optional<modbus::Exception> refused;
  const bool was_asked = guard([&] { refused = hooks_.refuse_read(table, range); },
                               [&](const char* what) { log_limited("refuse_read()", what); });
  // The former value of `refused` must not be relied on: GCC 12 forgets it with -O2.
  return was_asked ? refused : modbus::Exception::server_device_failure;
}

bool GuardedHooks::accept(std::uint32_t point, const std::uint16_t* registers) {
  bool accepted = false;
  const auto thrown = [&](const char* what) {
    log_limited(fmt::format("the hook of point '{}'", map_.points[point].name),
                fmt::format("{}; the write is refused", what));
  };
  const bool was_asked = guard([&] { accepted = hooks_.accept(point, registers); }, thrown);
  // Also of a hook that has thrown: otherwise it would be the reason of the next refusal.
  const std::string_view why = hooks_.take_reason();
  if (!was_asked) return false;
  if (!accepted && !why.empty())
    log_.warn_limited("refusal",
                      fmt::format("a write of point '{}' is refused: {}", map_.points[point].name, why));
  return accepted;
}

/// Outputs go to their safe state after a throw, since nothing has reacted to the input.
bool GuardedHooks::take_level(std::uint32_t point, bool level, bool is_news) {
  return guard([&] { (void)hooks_.take_level(point, level, is_news); },
               [&](const char* what) {
                 log_limited(fmt::format("the hook of point '{}'", map_.points[point].name),
                             fmt::format("{}; outputs go to their safe state", what));
               });
}

void GuardedHooks::not_driven(const WantedOutput& wanted, bool watchdog) {
  log_.warn_limited(
      "not driven",
      fmt::format("the program could not switch point '{}' {}: {}", map_.points[wanted.point].name,
                  wanted.level ? "on" : "off",
                  watchdog ? "the watchdog has expired, and no client has written an output since"
                           : "its line cannot be driven"));
}

}  // namespace coupler::device
