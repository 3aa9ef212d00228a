// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "coupler/device/core/client_session.hpp"
#include "coupler/map/map.hpp"
#include "coupler/modbus/pdu.hpp"

namespace coupler::device {

/// What a request without the right for it is answered.
constexpr modbus::Exception no_right = modbus::Exception::illegal_function;

/// What a client may do by its role. Without `security` in the map it may do everything. A right is asked for
/// after the address was found to be mapped, and before a value is looked at (docs/security.md).
class Rights {
 public:
  /// The map outlives it.
  Rights(const Map& map, const ClientSession& client);

  bool are_limited() const { return are_limited_; }
  /// Whether all points that have an address in the range may be read, or written.
  bool may(Right right, Table table, modbus::Range range) const;
  /// Whether all points that have one of the bits of a holding register may be written (FC 22).
  bool may_write_bits(std::uint16_t address, std::uint16_t bits) const;
  /// Whether there is a point that may be written.
  bool may_write_any() const;
  /// Whether all that the node says of itself may be read: its map, and its statistics.
  bool reads_all() const { return !are_limited_ || (role_ != nullptr && role_->reads_all); }
  bool may(Right right, const Point& point) const;

 private:
  const Map& map_;
  const Role* role_ = nullptr;  ///< nullptr: nothing is allowed, if anything is limited
  bool are_limited_;
};

}  // namespace coupler::device
