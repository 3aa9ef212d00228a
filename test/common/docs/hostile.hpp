// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "coupler/docs/document.hpp"
#include "test/fakes/map_builder.hpp"

namespace coupler::test {

constexpr std::string_view hostile_text = "</script><script>alert(1)</script> | `x` --> \"q\"\nnext";

/// Every text that a map may choose freely tries to be more than a text.
inline docs::Document hostile_document() {
  auto builder = fakes::MapBuilder("cell");
  builder.head().connection.address = hostile_text;
  builder.head().service.listen = hostile_text;
  builder.add(Table::coils, "lamp", 0, codec::Type::BOOL, [](Point& point) {
    point.description = hostile_text;
    point.units = hostile_text;
    point.line.name = hostile_text;
  });
  builder.add(Table::holding_registers, "dac", 3, codec::Type::INT, [](Point& point) {
    point.iio = {hostile_text, hostile_text};
  });
  builder.add(Table::holding_registers, "button_latch", 9, codec::Type::BOOL, [](Point& point) {
    point.latched = {hostile_text, Edge::both};
  });
  const auto map = builder.build();
  const std::vector<int> lines{4, 7, 9};
  return docs::make_document(map->map(), lines, {std::string(hostile_text), "a.yaml", "1.2.3"});
}

}  // namespace coupler::test
