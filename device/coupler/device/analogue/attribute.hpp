// SPDX-License-Identifier: Apache-2.0
// Files of sysfs, in which the kernel shows what a device has.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <tl/expected.hpp>
#include <vector>

#include "coupler/base/descriptor.hpp"

namespace coupler::device {

/// A file with a number that stays open: to read or write it is one system call and allocates nothing.
class Attribute {
 public:
  enum class For { reading, writing };

  /// The error is an errno.
  static tl::expected<Attribute, int> open(const std::string& path, For purpose);

  /// The error is an errno; EBADMSG: there is not a number in it.
  tl::expected<double, int> read() const;
  /// Returns 0 or an errno.
  [[nodiscard]] int write(std::int64_t value) const;

 private:
  explicit Attribute(Descriptor file) : file_(std::move(file)) {}
  Descriptor file_;
};

/// The first line; nullopt if the file cannot be read.
std::optional<std::string> read_text(const std::string& path);

/// The number in a file that is read once.
tl::expected<double, int> read_number(const std::string& path);

/// Names in the folder that begin with `prefix`, shorter ones first: "pwmchip2" before "pwmchip10".
std::vector<std::string> names_in(const std::string& folder, const std::string& prefix);

/// Returns what a user can do about an errno; it begins with "; ", or is empty.
std::string remedy_for(int error, const std::string& path);

}  // namespace coupler::device
