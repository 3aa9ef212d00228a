// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "coupler/host/core/clock.hpp"
#include "coupler/host/core/write.hpp"
#include "coupler/modbus/pdu.hpp"

namespace coupler::host {

/// How far the last value of a point can be trusted, and the result of the last write to it.
struct PointQuality {
  enum class State : std::uint8_t {
    good,
    stale,       ///< nothing new has come for two periods of its rate and a timeout
    never_read,  ///< not read since the program began
    exception,   ///< the last read was answered with an exception
    rejected,    ///< the device does not have it, or it is set aside
    offline,     ///< the device does not answer
    not_wanted,  ///< not read, because nobody listens to it
    invalid,     ///< what was read is no value: see Point::invalid and Scale::exponent_of
    fault        ///< what was read says that something is broken: see Point::faults
  };
  State state = State::never_read;
  Time stale_from = Time::max();    ///< the time at which a good value becomes stale if nothing new comes
  std::optional<Time> last_good{};  ///< the time of the last reading, usable or not
  std::optional<modbus::Exception> last_exception{};  ///< the last exception, however long ago
  std::string why{};  ///< what came instead of a reply, or why what came is no value; empty otherwise
  std::optional<WriteResult::Outcome> last_write{};  ///< that of the last write that was not superseded
  std::string last_write_text{};                     ///< to_string() of its result

  /// Returns whether what was read is not published: it is no value, or a fault.
  static bool is_unusable(State state) { return state == State::invalid || state == State::fault; }
  /// Returns whether the device did not give the value when it was last asked, though it is online.
  bool is_refused() const { return is_refused(state); }
  static bool is_refused(State state) { return state == State::exception || state == State::rejected; }
  /// The exception of a point that is refused now; 0 if something else came instead of a reply, as `why`
  /// says.
  unsigned refused_with() const {
    return why.empty() && last_exception ? static_cast<unsigned>(*last_exception) : 0;
  }
};

/// Returns a text as "good" or "never read".
std::string_view to_string(PointQuality::State state);

}  // namespace coupler::host
