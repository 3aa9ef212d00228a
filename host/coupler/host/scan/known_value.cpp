// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/scan/known_value.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <tuple>
#include <type_traits>

#include <fmt/format.h>

#include "coupler/codec/number.hpp"
#include "coupler/map/loader/names.hpp"
#include "coupler/map/loader/scalar.hpp"

namespace coupler::scan {
namespace {

/// Half of the last digit: of "230.4" 0.05, of "12e3" 500.
double exactness(std::string_view number) {
  const auto exponent_at = std::min(number.find_first_of("eE"), number.size());
  const std::string_view digits = number.substr(0, exponent_at);
  const auto point = digits.find('.');
  const double decimals =
      point == std::string_view::npos ? 0 : static_cast<double>(digits.size() - point - 1);
  const auto exponent =
      exponent_at < number.size() ? loader::parse_number(number.substr(exponent_at + 1)).value_or(0) : 0;
  return 0.5 * std::pow(10, exponent - decimals);
}

using codec::Order;
using codec::Type;

constexpr std::array<Order, 4> orders{Order::ABCD, Order::CDAB, Order::BADC, Order::DCBA};

/// How many of all contents of the registers are numbers within the tolerance.
template <class T>
double chance_of_float(const KnownValue& known) {
  const auto value = static_cast<T>(known.value);
  const double step = std::nextafter(value, std::numeric_limits<T>::infinity()) - value;
  return std::max(1.0, 2 * known.tolerance / step) / std::pow(2, 8 * sizeof(T));
}

/// A high register of 0 proves nothing: many registers are 0. Scales are tried in turn, so each is worth
/// less.
template <class T>
double chance_of_integer(T raw, const KnownValue& known, int divisor) {
  const double matching = std::max(1.0, 2 * known.tolerance * divisor);
  const bool is_narrow = raw >= 0 && static_cast<double>(raw) <= 0xFFFF;
  const double contents = is_narrow ? 65536.0 : std::pow(2, 8 * sizeof(T));
  const double doubt = (is_narrow && sizeof(T) > 2 ? 2 : 1) * (divisor == 1 ? 1 : divisor == 10 ? 2 : 4);
  return std::min(1.0, matching / contents * doubt);
}

class Search {
 public:
  Search(const KnownValue& known, const TableFindings& table, std::vector<Candidate>& found)
      : known_(known), table_(table), found_(found) {}

  void at(modbus::Range range, std::uint32_t address) {
    const bool negative = known_.value < 0;
    for (const Type type :
         {negative ? Type::INT : Type::UINT, negative ? Type::DINT : Type::UDINT, Type::REAL, Type::LREAL}) {
      const std::uint32_t count = codec::width(type) / 16;
      if (address + count <= range.end()) as(type, modbus::Range::of(address, count));
    }
  }

 private:
  void as(Type type, modbus::Range place) {
    std::array<std::uint16_t, 4> words{};
    for (std::uint32_t i = 0; i < place.count(); ++i) words[i] = table_.value(place.start() + i);
    for (const Order order : orders) {
      if (place.count() == 1 && codec::words_reversed(order)) continue;
      codec::with_number(type, [&](auto zero) {
        const auto raw = codec::decode<std::conditional_t<sizeof zero == 1, std::uint16_t, decltype(zero)>>(
            words.data(), order);
        compare(raw, type, order, place);
      });
    }
  }
  template <class T>
  void compare(T raw, Type type, Order order, modbus::Range place) {
    for (const int divisor : {1, 10, 100}) {
      if (std::is_floating_point_v<T> && divisor != 1) break;
      const double value = static_cast<double>(raw) / divisor;
      if (!(std::abs(value - known_.value) <= known_.tolerance)) continue;
      double chance = 0;
      if constexpr (std::is_floating_point_v<T>)
        chance = chance_of_float<T>(known_);
      else
        chance = chance_of_integer(raw, known_, divisor);
      found_.push_back({table_.table(), place, type, order, divisor, value, chance});
    }
  }

  const KnownValue& known_;
  const TableFindings& table_;
  std::vector<Candidate>& found_;
};

bool is_better(const Candidate& a, const Candidate& b) {
  const auto key = [](const Candidate& c) {
    return std::tuple(c.chance, c.type, c.order, c.table, c.range.start(), c.divisor);
  };
  return key(a) < key(b);
}

bool stands_in(const Candidate& candidate, Order order) {
  if (candidate.range.count() > 1) return candidate.order == order;
  return codec::bytes_swapped(candidate.order) == codec::bytes_swapped(order);
}

}  // namespace

tl::expected<KnownValue, std::string> parse_known_value(std::string_view text) {
  KnownValue known;
  std::string_view number = text;
  if (const auto equals = text.find('='); equals != std::string_view::npos) {
    known.name = text.substr(0, equals);
    number = text.substr(equals + 1);
    if (!loader::is_relative_ros_name(known.name) || loader::is_driver_topic(known.name))
      return tl::make_unexpected(fmt::format(
          "'{}' cannot be a point's name; write a letter, then letters, digits and '_'", known.name));
  }
  std::optional<double> tolerance;
  for (const std::string_view sign : {"±", "+-"})
    if (const auto at = number.find(sign); at != std::string_view::npos) {
      tolerance = loader::parse_number(number.substr(at + sign.size()));
      number = number.substr(0, at);
      if (!tolerance || *tolerance < 0)
        return tl::make_unexpected(
            fmt::format("the tolerance in '{}' is not a number; write 230.4±0.5", text));
    }
  const auto value = loader::parse_number(number);
  if (!value)
    return tl::make_unexpected(
        fmt::format("'{}' is not a value; write a number, as 230.4, 230.4±0.5 or voltage=230.4", text));
  known.value = *value;
  known.tolerance = tolerance ? *tolerance : exactness(number);
  if (std::abs(known.value) <= known.tolerance)
    return tl::make_unexpected(
        fmt::format("'{}' may be 0, which is found everywhere; give a value other than 0", text));
  return known;
}

std::vector<Candidate> find_candidates(const KnownValue& known, const std::vector<TableFindings>& tables) {
  std::vector<Candidate> found;
  for (const TableFindings& table : tables) {
    if (holds_bits(table.table())) continue;
    Search search(known, table, found);
    for (const modbus::Range range : table.readable())
      for (std::uint32_t address = range.start(); address < range.end(); ++address) search.at(range, address);
  }
  std::sort(found.begin(), found.end(), is_better);
  return found;
}

const Candidate* choose(const std::vector<Candidate>& candidates, std::optional<Order> order) {
  for (const Candidate& candidate : candidates)
    if (!order || stands_in(candidate, *order)) return &candidate;
  return nullptr;
}

std::optional<Order> common_order(const std::vector<Match>& matches) {
  for (const Order order : orders) {
    bool agree = true;
    bool has_words = false;
    for (const Match& match : matches) {
      if (match.candidates.empty()) continue;
      const Candidate* best = choose(match.candidates, order);
      agree &= best != nullptr && best->chance <= match.candidates.front().chance;
      has_words |= best != nullptr && best->range.count() > 1;
    }
    if (agree && has_words) return order;
  }
  return std::nullopt;
}

}  // namespace coupler::scan
