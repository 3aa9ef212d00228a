// SPDX-License-Identifier: Apache-2.0
#include "test/bench/kernel/wire.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <string_view>

#include "test/bench/node/lock_step_client.hpp"

namespace coupler::bench {

Wire::Wire(const std::string& folder)
    : pull_(::open((folder + "/pull").c_str(), O_WRONLY | O_CLOEXEC)),
      value_(::open((folder + "/value").c_str(), O_RDONLY | O_CLOEXEC)) {
  if (pull_ < 0 || value_ < 0) give_up("no simulated line there");
}

Wire::~Wire() {
  ::close(pull_);
  ::close(value_);
}

void Wire::pull(bool up) const {
  const std::string_view text = up ? "pull-up" : "pull-down";
  if (::pwrite(pull_, text.data(), text.size(), 0) != static_cast<ssize_t>(text.size()))
    give_up("cannot pull a line");
}

bool Wire::level() const {
  char digit = 0;
  if (::pread(value_, &digit, 1, 0) != 1) give_up("cannot read a line's level");
  return digit == '1';
}

}  // namespace coupler::bench
