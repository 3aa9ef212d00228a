// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace coupler {

/// What the lock of a map is read for.
enum class LockUse {
  read,   ///< to serve the map or to generate from it: a point whose address it does not know is an error
  exact,  ///< to make sure that it is up to date: the same, and it is an error if `renew` would change it
  renew   ///< to be brought up to date: such a point gets an address
};

/// The lock beside a map (coupler/map/lock/lock.hpp).
struct LockFile {
  std::string path;                 ///< as messages call it; empty: the map is no file, so it can have none
  std::optional<std::string> text;  ///< nullopt: there is none
  LockUse use = LockUse::read;
};

/// What `renew` makes of a lock.
struct NewLock {
  std::string path;
  std::string text;                    ///< empty: the lock is up to date, or nothing needs one
  std::vector<std::string> allocated;  ///< points that got an address
  std::vector<std::string> retired;    ///< points that are there no more, or give an address of their own
};

}  // namespace coupler
