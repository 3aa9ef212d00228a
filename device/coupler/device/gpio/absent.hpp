// SPDX-License-Identifier: Apache-2.0
// What stands in the place of lines that cannot be had now: their chip is unplugged.
#pragma once

#include <cerrno>
#include <string>
#include <utility>

#include "coupler/device/gpio/line_group.hpp"

namespace coupler::device {

template <class Group>
class Absent : public Group {
 public:
  explicit Absent(std::string name) : name_(std::move(name)) {}
  const std::string& name() const override { return name_; }
  bool is_plugged() override { return false; }

 private:
  std::string name_;
};

class AbsentOutputs : public Absent<OutputGroup> {
 public:
  using Absent::Absent;
  int drive(Span<const int>) override { return ENODEV; }
  int read(Span<int>) override { return ENODEV; }
};

class AbsentInputs : public Absent<InputGroup> {
 public:
  using Absent::Absent;
  int read(Span<int>, TimePoint) override { return ENODEV; }
};

}  // namespace coupler::device
