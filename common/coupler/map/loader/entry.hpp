// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace coupler::loader {

/// A place in the file. Lines and columns count from 1, columns in bytes.
struct Position {
  int line = 0;
  int column = 0;
};

/// One value of the file, with its key and everything below it. Duplicate keys are still there.
struct Entry {
  enum class Kind { null, scalar, list, map };

  std::string key;  ///< if it stands in a map
  Position key_at;
  Kind kind = Kind::null;
  Position at;  ///< the value; the key's for what has no place of its own (nothing that is not written as '~'
                ///< or 'null', or a block below the key)
  std::string text;     ///< scalar
  bool quoted = false;  ///< a scalar that can only be text
  std::vector<Entry> children;
};

}  // namespace coupler::loader
