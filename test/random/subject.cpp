// SPDX-License-Identifier: Apache-2.0
#include "test/random/subject.hpp"

namespace coupler::random {

std::vector<Subject>& subjects() {
  static std::vector<Subject> all;
  return all;
}

}  // namespace coupler::random
