// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "coupler/codec/order.hpp"
#include "coupler/map/loader/address.hpp"
#include "coupler/map/loader/context.hpp"
#include "coupler/map/loader/draft_point.hpp"
#include "coupler/map/loader/entry.hpp"
#include "coupler/map/loader/host_options_reader.hpp"
#include "coupler/map/loader/reader.hpp"

namespace coupler::loader {

/// What the top of the file says about all points.
struct PointDefaults {
  Addressing addressing = Addressing::zero_based;
  codec::Order order =
      codec::Order::CDAB;  ///< of values of two and four registers; fewer keep the bytes' part
  HostDefaults host{};
};

// One entry of a table, `name: address` (coils and discrete inputs) or `name: {options}`, is read in two
// steps, for in between those without an address get theirs. `options` is its reader in both.

/// What decides where the point may stand.
DraftPoint read_place(const Entry& entry, Table table, const Reader& options, const PointDefaults& defaults,
                      Context& context);

/// Everything else; values are as they stand in their registers, so this needs the place.
void read_rest(const Reader& options, const PointDefaults& defaults, DraftPoint& draft, Context& context);

}  // namespace coupler::loader
