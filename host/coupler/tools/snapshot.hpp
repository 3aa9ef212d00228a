// SPDX-License-Identifier: Apache-2.0
// What was read from a device at one moment.
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "coupler/host/core/error.hpp"
#include "coupler/host/core/identity_check.hpp"

namespace coupler::tools {

struct Reading {
  enum class State : std::uint8_t {
    good,
    fault,     ///< was read, and says that something is broken
    invalid,   ///< was read, and is no value
    failed,    ///< was to be read
    not_asked  ///< the map says that it cannot be read
  };
  std::uint32_t point;  ///< index into Map::points
  State state = State::failed;
  std::vector<std::uint16_t>
      registers{};    ///< as TypedValue takes them; good only: no value outlives its look
  std::string why{};  ///< there is no value
  std::optional<modbus::Exception> exception{};  ///< if that is why
  bool changed = false;                          ///< see mark_changes()
};

struct Snapshot {
  std::chrono::system_clock::time_point at;
  std::optional<host::Error> error{};                 ///< why the device does not answer; nullopt: it does
  std::optional<host::Identity::Verdict> identity{};  ///< nullopt: not answered
  std::vector<std::string> notes{};                   ///< about this connection, one or more lines each
  std::vector<Reading> readings{};                    ///< of the chosen points, in the map's order

  bool online() const { return !error; }
  std::size_t failed() const;
};

/// Marks the readings that differ from the last time.
void mark_changes(const Snapshot& before, Snapshot& now);

}  // namespace coupler::tools
