// SPDX-License-Identifier: Apache-2.0
// Writes as requests: several in one, sent, and read back.
#pragma once

#include <array>
#include <vector>

#include "coupler/host/core/link.hpp"
#include "coupler/host/core/write.hpp"
#include "coupler/modbus/client.hpp"
#include "coupler/modbus/limits.hpp"
#include "coupler/modbus/range.hpp"

namespace coupler::host {

/// Returns whether a write to the point needs a read before it, because the point is a part of a register and
/// the device has no FC 22 (mask write).
bool needs_read(const Map& map, const Point& point);

/// The writes of one request: a single one, or several that are neighbours both in the queue and in the
/// device.
class WriteBatch {
 public:
  /// The map must outlive the batch.
  explicit WriteBatch(const Map& map) : map_(&map) {}

  /// Adds the write if it is the first one or fits into the same request: it is a neighbour in the same
  /// table, within the limits of a request, and neither of them has `write_function: single`, `write_queue:
  /// every` or is part of a register.
  bool add(const Write& write);
  void clear() { writes_.clear(); }

  bool empty() const { return writes_.empty(); }
  /// The writes in the order of add().
  const std::vector<Write>& writes() const { return writes_; }

  /// `before` is the value of the register if needs_read(). The batch must not be empty.
  modbus::WriteRequest request(std::uint16_t before = 0) const;

 private:
  const Point& point(const Write& write) const { return map_->points[write.point]; }
  bool merges(const Write& write) const;
  modbus::WriteRequest part_request(std::uint16_t before) const;

  const Map* map_;
  std::vector<Write> writes_;
  modbus::Range range_ = modbus::Range::of(0, 1);  ///< the range of all of them
};

/// Sends the request of a batch, after the read that a part of a register may need. Link::receive() must
/// follow, but not after an error: nothing was sent then.
Result<> send(const WriteBatch& batch, const Map& map, Link& link);

/// A value that the device did not take.
struct RejectedValue {
  std::uint32_t point;
  ExceptionReply reply;
};

/// Writes values that no caller waits for, neighbours in one request. Returns those that were rejected. An
/// error means that the connection broke during the request of `broken`.
Result<std::vector<RejectedValue>> write_values(const std::vector<Write>& writes, const Map& map, Link& link,
                                                std::vector<Write>* broken = nullptr);

/// Compares what a point holds after a write with what was written.
class ReadBack {
 public:
  /// Reads the point from the place where it reads back.
  Result<> read(const Write& write, const Map& map, Link& link);

  /// Compares only the point's own bits.
  bool is_equal() const;
  /// The value that was read, in the form of Point::initial. It is valid as long as this object.
  Span<const std::uint16_t> written() const { return {written_.data(), count_}; }
  Span<const std::uint16_t> found() const { return {found_.data(), count_}; }

 private:
  std::array<std::uint16_t, modbus::max_read_bits> written_{};
  std::array<std::uint16_t, modbus::max_read_bits> found_{};
  std::size_t count_ = 0;
};

}  // namespace coupler::host
