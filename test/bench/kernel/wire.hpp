// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace coupler::bench {

/// A line of a gpio-sim chip seen from outside. Errors end the program, as in Line.
class Wire {
 public:
  /// `folder` is the line's in sysfs, ".../sim_gpio0".
  explicit Wire(const std::string& folder);
  Wire(const Wire&) = delete;
  Wire& operator=(const Wire&) = delete;
  ~Wire();

  void pull(bool up) const;
  bool level() const;

 private:
  int pull_;
  int value_;
};

}  // namespace coupler::bench
