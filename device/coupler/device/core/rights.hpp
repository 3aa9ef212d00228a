// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "coupler/device/core/client_session.hpp"
#include "coupler/map/map.hpp"
#include "coupler/modbus/pdu.hpp"

namespace coupler::device {

/// The exception that answers a request without the right to it.
constexpr modbus::Exception no_right = modbus::Exception::illegal_function;

/// The rights of a client by its role. Without `security` in the map it may do everything. Rights are checked
/// after the address was found to be mapped, and before a value is looked at (docs/security.md).
class Rights {
 public:
  /// The map outlives it.
  Rights(const Map& map, const ClientSession& client);

  bool are_limited() const { return are_limited_; }
  /// Returns whether the client may read, or write, all points with an address in the range.
  bool may(Right right, Table table, modbus::Range range) const;
  /// Returns whether the client may write all points with one of these bits of a holding register (FC 22).
  bool may_write_bits(std::uint16_t address, std::uint16_t bits) const;
  /// Returns whether there is a point that the client may write.
  bool may_write_any() const;
  /// Returns whether the client may read all that the node says of itself: its map and its statistics.
  bool reads_all() const { return !are_limited_ || (role_ != nullptr && role_->reads_all); }
  bool may(Right right, const Point& point) const;

 private:
  const Map& map_;
  const Role* role_ = nullptr;  ///< nullptr: nothing is allowed, if anything is limited
  bool are_limited_;
};

}  // namespace coupler::device
