// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "coupler/device/gpio/edge_tally.hpp"
#include "coupler/device/gpio/event_source.hpp"
#include "coupler/device/gpio/libgpiod2/request.hpp"
#include "coupler/device/gpio/line_group.hpp"
#include "coupler/device/supervisor/shared_array.hpp"

namespace coupler::device::libgpiod2 {

/// Inputs of one request: one system call reads them all, one descriptor reports the edges of those that are
/// counted. The kernel debounces, and numbers its events: what it drops is seen as a gap.
class Inputs : public InputGroup, public EventSource {
 public:
  /// `request` holds `lines`, in this order.
  Inputs(Request request, const std::vector<LineSpec>& lines);

  const std::string& name() const override { return name_; }
  bool is_plugged() override { return request_.is_plugged(); }
  int read(Span<int> levels, TimePoint now) override;
  int descriptor() const override;
  bool take_edges() override;
  Edges edges(std::size_t line, TimePoint now) override;

 private:
  struct Counted {
    unsigned offset = 0;
    EdgeTally tally;
    std::uint32_t sequence = 0;  ///< of the line's last event; the kernel begins with 1
  };

  void add(gpiod_edge_event* event);

  Request request_;
  Owned<gpiod_edge_event_buffer, gpiod_edge_event_buffer_free> events_;
  std::array<gpiod_line_value, max_group_size> values_{};
  SharedArray<Counted> lines_;  ///< shared: a process that is started anew sees no gap in their sequence
  std::string name_;
};

}  // namespace coupler::device::libgpiod2
