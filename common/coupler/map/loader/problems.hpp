// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "coupler/map/diagnostic.hpp"
#include "coupler/map/loader/document.hpp"

namespace coupler::loader {

/// Another place of the file, and what is there.
struct Note {
  Position at;
  std::string what;
};

/// Collects what is wrong with one file.
class Problems {
 public:
  explicit Problems(std::string_view file) : file_(file) {}

  /// `related`: other places of the file that have to do with it.
  using Notes = std::vector<Note>;

  void error(Position at, std::string what, std::string remedy, const Notes& related = {});
  void warning(Position at, std::string what, std::string remedy, const Notes& related = {});

  /// No more are kept, but errors are counted: nobody reads so many.
  bool is_full() const { return found_.size() >= most; }
  bool has_errors() const { return errors_ > 0; }
  std::size_t errors() const { return errors_; }
  /// In the order of the file.
  Diagnostics sorted() &&;

 private:
  static constexpr std::size_t most = 10'000;

  void add(Diagnostic::Severity severity, Position at, std::string what, std::string remedy,
           const Notes& related);

  std::string file_;
  Diagnostics found_;
  std::size_t errors_ = 0;
};

/// Text of the file as a message shows it: in quotes, on one line, no longer than about 40 characters.
std::string shown(std::string_view text);

}  // namespace coupler::loader
