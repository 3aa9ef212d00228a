// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "coupler/map/lock/lock.hpp"

namespace coupler::lock {

/// A point without an address.
struct Request {
  std::string_view name;
  Table table = Table::coils;
  std::uint32_t size = 1;              ///< addresses
  std::uint16_t alignment = 1;         ///< its first address is a multiple of it
  std::vector<std::uint16_t> masks{};  ///< the bits of a register that would do, the best first; none: whole
};

/// The places where points may be put.
struct FreeSpace {
  std::vector<Place> closed;  ///< nothing is put there
  std::vector<Place> open;    ///< if a table has any, points are put within one of them only
};

enum class Unknown { refused, allocated };

/// The result of a request.
struct Answer {
  enum class Kind {
    recalled,   ///< the lock knows its place
    allocated,  ///< it is new
    misfit,     ///< the lock's place is too small, or does not hold what is asked for
    unknown,    ///< the lock does not know it, and nothing may be allocated
    full        ///< there is no place left
  };
  Kind kind = Kind::unknown;
  Place place{};                 ///< of what was recalled or allocated
  const Entry* entry = nullptr;  ///< in the old lock: of what was recalled or is a misfit
};

struct Allocation {
  std::vector<Answer> answers;  ///< one for each request
  Lock lock;                    ///< the new one
};

/// Gives each request the place that `lock` has for it. The others, in their order and if they may be
/// `allocated`, get the first place that is neither closed nor taken in the lock. Every entry of the old lock
/// is in the new one: retired if no request asked for it, in use again if one did.
Allocation allocate(const std::vector<Request>& requests, const FreeSpace& free_space, const Lock& lock,
                    Unknown unknown);

}  // namespace coupler::lock
