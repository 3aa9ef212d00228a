// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "coupler/codec/value.hpp"
#include "coupler/map/point.hpp"

namespace coupler::test_vectors {

/// codec::registers(point.format) registers: what one value of the point may look like on the wire.
using Element = std::vector<std::uint16_t>;

std::vector<Element> number_elements(const codec::Format& format);
std::vector<Element> text_elements(const codec::Format& format);

/// What a writer may not send: numbers next to the ends of an integer type, beyond those of a scale or of
/// REAL; texts that are too long or have a character that the encoding has not.
std::vector<codec::Value> refused_numbers(codec::Type type);
std::vector<codec::Value> refused_scaled(codec::Type type, const codec::Scale& scale);
std::vector<codec::Value> refused_texts(const codec::Format& format);

}  // namespace coupler::test_vectors
