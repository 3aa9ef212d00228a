// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <thread>
#include <vector>

#include "coupler/device/net/loop.hpp"
#include "coupler/device/node/serving_context.hpp"
#include "test/device/core/fake_log.hpp"

namespace coupler::random {

/// A node on a free loopback port, in a thread of its own. If the map has lines they are simulated.
class NodeEnd {
 public:
  /// Both outlive it; `hooks` may be null.
  NodeEnd(const Map& map, device::Hooks* hooks);
  ~NodeEnd();
  NodeEnd(const NodeEnd&) = delete;
  NodeEnd& operator=(const NodeEnd&) = delete;

  std::uint16_t port() const;
  /// Whether put() and hooks bring its value. Where a simulated wire ends they do not.
  bool is_shown(const Point& point) const;
  /// The registers or bits of a point in the image, without what others have in them.
  std::vector<std::uint16_t> raw(const Point& point);
  /// Puts them there, as hardware would.
  void put(const Point& point, const std::vector<std::uint16_t>& raw);

 private:
  /// Runs it between two requests.
  void between_requests(const std::function<void()>& work);
  void run();

  class Bell;

  const bool simulated_;
  device::FakeLog log_;
  device::Loop loop_;
  device::ServingContext context_;
  std::unique_ptr<Bell> bell_;
  std::thread thread_;
};

}  // namespace coupler::random
