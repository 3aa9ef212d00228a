// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "coupler/base/enumeration.hpp"
#include "coupler/map/fields.hpp"
#include "coupler/map/loader/document.hpp"
#include "coupler/map/loader/keys.hpp"
#include "coupler/map/loader/problems.hpp"
#include "coupler/map/owned_map.hpp"

namespace coupler::loader {

/// The data that all readers of one file share.
struct Context {
  Problems& problems;
  OwnedMap& map;  ///< keeps the texts that points refer to
  /// A node serves the map. It may be newer than this program: what is not known here is a warning.
  bool served = false;
  /// The file may be one of ros-modbus-device-driver, which ignores keys: those unlike all of ours are
  /// warnings.
  bool foreign = false;
  std::string_view folder{};  ///< of the file, where paths in it begin

  /// The user cannot change a served map: load_node_map() says what to do.
  std::string unless_served(std::string remedy) const { return served ? std::string() : std::move(remedy); }
  void problem(bool is_warning, Position at, std::string what, std::string remedy) const {
    if (is_warning)
      problems.warning(at, what + ", ignored", std::move(remedy));
    else
      problems.error(at, std::move(what), std::move(remedy));
  }
};

/// One map of the file, read by the table of keys. Whatever is wrong becomes a problem. The getters leave
/// `out` as it was then, and when the key is absent.
class Reader {
 public:
  /// Checks the keys: known in this section, given once. `map` must be a map, or nothing.
  Reader(const Entry& map, Section section, const Context& context);

  /// The value of the key, or nullptr.
  const Entry* find(std::string_view key) const;
  bool has(std::string_view key) const { return find(key) != nullptr; }
  /// The key is absent, and not misspelt either, in which case an error has named the right spelling.
  bool lacks(std::string_view key) const { return !has(key) && !misspells(key); }
  bool misspells(std::string_view key) const;
  /// The section has a key of that name.
  bool knows(std::string_view key) const { return find_key(key, section_) != nullptr; }
  /// The first required key that is absent, preferably one that is not misspelt; empty if there is none. For
  /// sections without a type.
  std::string_view missing() const;
  std::string_view example(std::string_view key) const { return find_key(key, section_)->example; }

  /// By the type of `out`.
  template <class T>
  void read(std::string_view key, T& out) const {
    if constexpr (std::is_same_v<T, bool>)
      boolean(key, out);
    else if constexpr (std::is_enum_v<T>)
      choice(key, out);
    else if constexpr (std::is_integral_v<T>)
      integer(key, out);
    else if constexpr (std::is_same_v<T, double>)
      number(key, out);
    else if constexpr (std::is_same_v<T, std::string_view>)
      text(key, out);
    else if constexpr (has_fields<T>)
      section(key, out);
    else
      duration(key, out);
  }
  template <class T>
  void integer(std::string_view key, T& out) const {
    if (const auto value = integer_in_range(key)) out = static_cast<T>(*value);
  }
  void number(std::string_view key, double& out) const;
  void boolean(std::string_view key, bool& out) const;
  /// Kept by the map under construction.
  void text(std::string_view key, std::string_view& out) const;
  /// Whole units of Duration.
  template <class Duration>
  void duration(std::string_view key, Duration& out) const {
    const auto value = duration_in_range(key);
    if (!value) return;
    const auto rounded = std::chrono::duration_cast<Duration>(*value);
    if (rounded == *value)
      out = rounded;
    else
      too_fine(key);
  }
  /// All keys of fields_of(Struct) that are given; those of another section cannot be.
  template <class Struct>
  void fields(Struct& out) const {
    for_each_field(out, [this](const auto& listed, auto& value) {
      if (field(listed.key) != nullptr) read(listed.key, value);
    });
  }

  /// A map with the keys of fields_of(Struct).
  template <class Struct>
  void section(std::string_view key, Struct& out) const {
    if (const auto below = inside(key, "a map")) below->fields(out);
  }

  template <class E>
  void choice(std::string_view key, E& out) const {
    if (const auto value = parse_word<E>(chosen_word(key))) out = *value;
  }

  /// The map below a key. Nothing if the key is absent, or if its value is not a map, which is a problem.
  std::optional<Reader> inside(std::string_view key, std::string_view expected) const;

  /// "'key' is …, not …", with the key's example as the remedy.
  void wrong(std::string_view key, std::string_view expected) const;
  /// The key is known, but does not apply here.
  void refuse(std::string_view key, std::string what, std::string remedy) const;

 private:
  struct Field {
    const Key* key;
    const Entry* value;
  };

  void check_key(const Entry& entry);
  void unknown(const Entry& entry);
  void misplaced(const Entry& entry, Section elsewhere) const;
  const Field* field(std::string_view key) const;
  std::optional<std::int64_t> integer_in_range(std::string_view key) const;
  std::optional<std::chrono::microseconds> duration_in_range(std::string_view key) const;
  /// One of Key::choices, or empty.
  std::string_view chosen_word(std::string_view key) const;
  void too_fine(std::string_view key) const;

  Section section_;
  const Context& context_;
  std::vector<Field> fields_;
  std::vector<std::string_view> misspelt_;  ///< known keys
};

/// The value as a message shows it: the text of a scalar, or "a list", "a map", "nothing".
std::string shown(const Entry& value);

/// The value is no map, but a text below its key, as 'valve:0' without the blank: that is a problem.
bool is_entry_without_colon(const Entry& entry, const Context& context);

/// The entry is a map or empty. Otherwise it is a problem, which begins with `expected`.
bool check_map(const Entry& entry, std::string_view expected, std::string_view remedy,
               const Context& context);

/// The file may be one of ros-modbus-device-driver: all its keys are known there, and every point has an
/// address.
bool has_only_inherited_keys(const Entry& root);

}  // namespace coupler::loader
