// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>
#include <unordered_map>

#include "coupler/base/span.hpp"

namespace coupler {

/// Finds elements by name, mostly in their own order, as when two versions of a map are compared: the element
/// after the last one found is tried first, and an index is only built when that fails. `name_of(element)` is
/// its name.
template <class T, class NameOf>
class LookupByName {
 public:
  LookupByName(Span<T> elements, NameOf name_of) : elements_(elements), name_of_(name_of) {}

  /// nullptr: there is none.
  T* find(std::string_view name) {
    T* found = next_ < elements_.size() ? &elements_[next_] : nullptr;
    if (found == nullptr || name_of_(*found) != name) found = find_in_index(name);
    if (found != nullptr) next_ = static_cast<std::size_t>(found - elements_.begin()) + 1;
    return found;
  }

 private:
  T* find_in_index(std::string_view name) {
    if (index_.empty())
      for (T& element : elements_) index_.emplace(name_of_(element), &element);
    const auto found = index_.find(name);
    return found == index_.end() ? nullptr : found->second;
  }

  Span<T> elements_;
  NameOf name_of_;
  std::size_t next_ = 0;
  std::unordered_map<std::string_view, T*> index_;
};

}  // namespace coupler
