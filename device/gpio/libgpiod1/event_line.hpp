// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <memory>

#include "device/gpio/debounce.hpp"
#include "device/gpio/event_source.hpp"
#include "device/gpio/libgpiod1/request.hpp"
#include "device/gpio/line_group.hpp"

namespace coupler::node::libgpiod1 {

/// An input that is debounced here: libgpiod 1 has no debounce, but it has edges and their times. Each such
/// line has a descriptor of its own.
class EventLine : public InputGroup, public EventSource {
 public:
  /// `request` holds one line, requested for edges.
  EventLine(std::unique_ptr<Request> request, std::chrono::microseconds debounce);

  const std::string& name() const override { return request_->name(); }
  int read(Span<int> levels, TimePoint now) override;
  int descriptor() const override { return descriptor_; }
  bool take_edges() override;

 private:
  std::unique_ptr<Request> request_;
  int descriptor_;
  Debounce debounce_;
};

}  // namespace coupler::node::libgpiod1
