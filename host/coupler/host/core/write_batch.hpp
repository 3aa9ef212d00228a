// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "coupler/host/core/write.hpp"
#include "coupler/modbus/client.hpp"
#include "coupler/modbus/range.hpp"

namespace coupler::host {

/// The writes of one request: one, or several that are next to each other both in the queue and in the
/// device.
class WriteBatch {
 public:
  /// What `map` views must outlive the batch.
  explicit WriteBatch(const Map& map) : map_(map) {}

  /// Takes the write if it is the first one or goes into the same request: a neighbour in the same table,
  /// within the limits of a request, neither of them `write_function: single`, `write_queue: every` or part
  /// of a register.
  bool add(const Write& write);
  void clear() { writes_.clear(); }

  bool empty() const { return writes_.empty(); }
  /// In the order of add().
  const std::vector<Write>& writes() const { return writes_; }

  /// One that shares its register with others, which a device without FC 22 needs to be told, too: the
  /// register must be read first.
  bool needs_read() const;
  /// `before`: the register as it is, where that is needed. Not of an empty batch.
  modbus::WriteRequest request(std::uint16_t before = 0) const;

 private:
  const Point& point(const Write& write) const { return map_.points[write.point]; }
  bool merges(const Write& write) const;
  modbus::WriteRequest part_request(std::uint16_t before) const;

  Map map_;
  std::vector<Write> writes_;
  modbus::Range range_ = modbus::Range::of(0, 1);  ///< of all together
};

}  // namespace coupler::host
