// SPDX-License-Identifier: Apache-2.0
// The names of an enumeration's values, written once, beside it: a function `enumeration(E)` returns an
// Enumeration. The key table, the reader, the generated code and all that shows a map take the names from
// there.
#pragma once

#include <cstddef>
#include <optional>
#include <string_view>

namespace coupler {

template <class E>
struct Word {
  E value;
  std::string_view name;         ///< in C++
  std::string_view word = name;  ///< in a map; empty: the default, which a map cannot write
};

/// `words` are in the order in which messages list them.
template <class E, std::size_t N>
struct Enumeration {
  std::string_view type;  ///< in C++, without the namespace
  Word<E> words[N];
};

/// All there is for E.
template <class E>
constexpr auto enumeration_of = enumeration(E{});

template <class E>
constexpr const Word<E>* find_word(E value) {
  for (const Word<E>& each : enumeration_of<E>.words)
    if (each.value == value) return &each;
  return nullptr;
}

/// Returns the word for it in a map; otherwise its name in C++.
template <class E, class = decltype(enumeration(E{}))>
constexpr std::string_view to_string(E value) {
  const Word<E>* found = find_word(value);
  if (found == nullptr) return "?";
  return found->word.empty() ? found->name : found->word;
}

/// Returns the enumerator that the word of a map stands for.
template <class E>
constexpr std::optional<E> parse_word(std::string_view word) {
  for (const Word<E>& each : enumeration_of<E>.words)
    if (!word.empty() && each.word == word) return each.value;
  return std::nullopt;
}

/// The words of a map, separated by "|".
template <class E>
class JoinedWords {
 public:
  static constexpr std::string_view text() { return {joined.letters, joined.size}; }

 private:
  static constexpr std::size_t room() {
    std::size_t size = 0;
    for (const Word<E>& each : enumeration_of<E>.words) size += each.word.size() + 1;
    return size;
  }
  struct Joined {
    char letters[room()] = {};
    std::size_t size = 0;
  };
  static constexpr Joined join() {
    Joined result;
    for (const Word<E>& each : enumeration_of<E>.words) {
      if (each.word.empty()) continue;
      if (result.size > 0) result.letters[result.size++] = '|';
      for (const char letter : each.word) result.letters[result.size++] = letter;
    }
    return result;
  }
  static constexpr Joined joined = join();
};

}  // namespace coupler
