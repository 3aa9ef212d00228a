// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cerrno>
#include <memory>
#include <utility>

#include "device/gpio/libgpiod1/request.hpp"
#include "device/gpio/line_group.hpp"

namespace coupler::node::libgpiod1 {

/// Outputs of one request: one system call drives them all.
class Outputs : public OutputGroup {
 public:
  explicit Outputs(std::unique_ptr<Request> request) : request_(std::move(request)) {}
  const std::string& name() const override { return request_->name(); }
  int drive(Span<const int> levels) override {
    return gpiod_line_set_value_bulk(request_->bulk(), levels.data()) == 0 ? 0 : errno;
  }

 private:
  std::unique_ptr<Request> request_;
};

/// Inputs of one request: one system call reads them all.
class Inputs : public InputGroup {
 public:
  explicit Inputs(std::unique_ptr<Request> request) : request_(std::move(request)) {}
  const std::string& name() const override { return request_->name(); }
  int read(Span<int> levels, TimePoint) override {
    return gpiod_line_get_value_bulk(request_->bulk(), levels.data()) == 0 ? 0 : errno;
  }

 private:
  std::unique_ptr<Request> request_;
};

}  // namespace coupler::node::libgpiod1
