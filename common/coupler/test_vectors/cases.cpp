// SPDX-License-Identifier: Apache-2.0
#include "coupler/test_vectors/cases.hpp"

#include <algorithm>
#include <cmath>

#include "coupler/test_vectors/elements.hpp"

namespace coupler::test_vectors {
namespace {

std::vector<Element> elements_of(const Point& point) {
  if (holds_bits(point.table)) return {{0}, {1}};
  return point.format.type == codec::Type::STRING ? text_elements(point.format)
                                                  : number_elements(point.format);
}

/// No driver and no client writes others.
bool is_finite(const codec::Value& value) {
  if (const auto* single = std::get_if<float>(&value)) return std::isfinite(*single);
  if (const auto* real = std::get_if<double>(&value)) return std::isfinite(*real);
  return true;
}

/// `pick(i)`: which element is the i-th value.
template <class Pick>
Case make_case(const Point& point, const std::vector<Element>& elements, Pick pick) {
  Case made;
  for (std::size_t i = 0; i < point.count; ++i) {
    const Element& element = elements[pick(i) % elements.size()];
    made.raw.insert(made.raw.end(), element.begin(), element.end());
    made.values.push_back(decode(point, element.data()));
  }
  std::vector<std::uint16_t> written(made.raw.size());
  const std::size_t width = codec::registers(point.format);
  for (std::size_t i = 0; i < point.count; ++i)
    made.only_read |= !is_finite(made.values[i]) || !encode(made.values[i], point, &written[i * width]);
  made.only_read |= written != made.raw;
  return made;
}

std::vector<codec::Value> refused_by(const Point& point) {
  std::vector<codec::Value> values;
  if (holds_bits(point.table) || !is_writable(point)) return values;
  if (point.format.type == codec::Type::STRING)
    values = refused_texts(point.format);
  else if (point.scale.present())
    values = refused_scaled(point.format.type, point.scale);
  else
    values = refused_numbers(point.format.type);
  // A scale of a wide type rounds its own ends: what it still takes is no example.
  std::vector<std::uint16_t> registers(codec::registers(point.format));
  const auto taken = [&](const codec::Value& value) { return encode(value, point, registers.data()); };
  values.erase(std::remove_if(values.begin(), values.end(), taken), values.end());
  return values;
}

}  // namespace

codec::Value decode(const Point& point, const std::uint16_t* registers) {
  if (holds_bits(point.table)) return registers[0] != 0;
  if (point.scale.present()) return codec::published(registers, point.format, point.scale);
  return codec::decode(registers, point.format);
}

bool encode(const codec::Value& value, const Point& point, std::uint16_t* registers) {
  if (holds_bits(point.table)) {
    const bool* on = std::get_if<bool>(&value);
    if (on != nullptr) registers[0] = *on ? 1 : 0;
    return on != nullptr;
  }
  if (!point.scale.present()) return codec::encode(value, point.format, registers).has_value();
  const double* number = std::get_if<double>(&value);
  return number != nullptr &&
         codec::encode_published(*number, point.format, point.scale, registers) == codec::ScaleError::none;
}

Cases cases_of(const Point& point) {
  const std::vector<Element> elements = elements_of(point);
  std::vector<Case> cases;
  const auto add = [&](Case&& made) {
    const auto same = [&](const Case& other) { return other.raw == made.raw; };
    if (std::none_of(cases.begin(), cases.end(), same)) cases.push_back(std::move(made));
  };
  if (point.count > 1 && point.format.type == codec::Type::BOOL)
    for (const std::size_t all : {0U, 1U}) add(make_case(point, elements, [&](std::size_t) { return all; }));
  for (std::size_t first = 0; first < elements.size(); ++first)
    add(make_case(point, elements, [&](std::size_t i) { return first + i; }));
  return {std::move(cases), refused_by(point)};
}

}  // namespace coupler::test_vectors
