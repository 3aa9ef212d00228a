// SPDX-License-Identifier: Apache-2.0
// What a table leaves open is asked for once, however many cells have it.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "coupler/map/loader/problems.hpp"
#include "coupler/tools/formats/csv.hpp"

namespace coupler::formats {

enum class Question {
  order,          ///< which register of several comes first
  units,          ///< "0.1V"
  units_times,    ///< "x10"
  string_number,  ///< "string[6]"
};

class Questions {
 public:
  /// The first cell is told, with the number of others that ask the same.
  void ask(Question question, const Cell& cell, std::string what, std::string remedy);

  void tell(loader::Problems& problems) const;

 private:
  struct Asked {
    Question question;
    loader::Position at;
    std::string what;
    std::string remedy;
    std::size_t more = 0;
  };
  bool is_asked(Question question) const;

  std::vector<Asked> asked_;
};

}  // namespace coupler::formats
