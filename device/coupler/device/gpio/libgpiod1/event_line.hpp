// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <memory>
#include <optional>

#include "coupler/device/gpio/debounce.hpp"
#include "coupler/device/gpio/edge_tally.hpp"
#include "coupler/device/gpio/event_source.hpp"
#include "coupler/device/gpio/libgpiod1/request.hpp"
#include "coupler/device/gpio/line_group.hpp"
#include "coupler/device/supervisor/shared_array.hpp"

namespace coupler::device::libgpiod1 {

/// An input that is watched for edges: because they are counted, or to debounce it here, since libgpiod 1
/// has no debounce. Each such line has a descriptor of its own. Its events have no sequence number, and the
/// kernel drops those that come while its queue of 16 is full: a queue that was found full counts as one
/// edge lost, at least.
class EventLine : public InputGroup, public EventSource {
 public:
  /// `request` holds one line, requested for `watched` edges; both, if there is a debounce period.
  EventLine(std::unique_ptr<Request> request, Edge watched, std::chrono::microseconds debounce);

  const std::string& name() const override { return request_->name(); }
  bool is_plugged() override { return request_->is_plugged(); }
  int read(Span<int> levels, TimePoint now) override;
  int descriptor() const override { return descriptor_; }
  bool take_edges() override;
  Edges edges(std::size_t line, TimePoint now) override;

 private:
  void add(const gpiod_line_event& event);
  /// The line's own level is what counts where the queue may have been full. Returns 0 or an errno.
  int debounce_level(TimePoint now);

  /// What was seen of the line. Shared, so that a process that is started anew takes no edge for a lost one.
  struct Seen {
    EdgeTally tally;
    std::optional<Debounce> debounce;
  };
  EdgeTally& tally() { return seen_[0].tally; }
  std::optional<Debounce>& debounce() { return seen_[0].debounce; }

  std::unique_ptr<Request> request_;
  int descriptor_;
  SharedArray<Seen> seen_;
};

}  // namespace coupler::device::libgpiod1
