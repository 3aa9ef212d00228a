// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace coupler::loader {

/// A place in the file. Lines and columns count from 1, columns in bytes.
struct Position {
  int line = 0;
  int column = 0;
};

/// One value of the file, with its key and everything below it. Duplicate keys are kept.
struct Entry {
  enum class Kind { null, scalar, list, map };

  std::string key;  ///< if it stands in a map
  Position key_at;
  Kind kind = Kind::null;
  /// The place of the value, or of the key if the value is a block below the key, or is '~' or 'null'.
  Position at;
  std::string text;     ///< scalar
  bool quoted = false;  ///< a scalar that can only be text
  std::vector<Entry> children;
};

/// The child of that key, or nullptr.
const Entry* child(const Entry& entry, std::string_view key);

class Problems;

/// Says whether anchors, aliases and merge keys ('<<') are read. Values that an alias copies keep their
/// places.
enum class Aliases { refused, read };

/// The tree of a YAML or JSON text; nullopt, with the first syntax error in `problems`, if it is neither.
/// Several documents, tags and keys that are not text are syntax errors, too, and so are aliases unless they
/// are asked for: YAML allows them, a map does not need them.
std::optional<Entry> parse_document(std::string_view text, Problems& problems,
                                    Aliases aliases = Aliases::refused);

}  // namespace coupler::loader
