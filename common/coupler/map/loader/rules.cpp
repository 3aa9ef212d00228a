// SPDX-License-Identifier: Apache-2.0
#include "coupler/map/loader/rules.hpp"

#include <unordered_map>
#include <vector>

#include <fmt/format.h>

#include "coupler/map/loader/address.hpp"

namespace coupler::loader {
namespace {

/// The same text for the same line or channel, as far as the file shows. Empty: there is none.
std::string hardware(const Point& point) {
  // An ADC and a DAC of one device may number their channels alike.
  if (point.iio.present())
    return fmt::format("iio {} {} {}", to_string(point.table), point.iio.device, point.iio.channel);
  if (point.pwm.present()) return fmt::format("pwm {} {}", point.pwm.chip, point.pwm.channel);
  const Line& line = point.line;
  if (!line.present()) return {};
  if (!line.name.empty()) return std::string(line.name);
  constexpr std::string_view folder = "/dev/";
  const bool device_file = line.chip.substr(0, folder.size()) == folder;
  return fmt::format("{} {}", device_file ? line.chip.substr(folder.size()) : line.chip, line.offset);
}

void check_size(const DraftPoint& draft, std::string_view key, std::uint16_t limit, const Context& context) {
  const std::uint32_t size = range(draft.point).count();
  if (size > limit)
    context.problems.error(draft.name_at,
                           fmt::format("{} has {} {}, more than '{}' of 'limits' ({}) takes in one request",
                                       shown(draft.point.name), size,
                                       holds_bits(draft.point.table) ? "bits" : "registers", key, limit),
                           fmt::format("make it shorter, or raise '{}' if the device takes more", key));
}

/// The remedy for a point that shares its register, which is read before it is written.
constexpr const char* for_itself = "give it a register of its own, or 'limits: {mask_write: true}'";

/// Bits of one address, and whose they are.
struct Claim {
  std::uint16_t mask;
  const DraftPoint* owner;
};

bool is_wired(const Point& point) { return point.line.present() || is_analogue(point); }

bool tolerable(const Point& a, const Point& b) {
  return !(is_writable(a) && is_writable(b)) && !is_wired(a) && !is_wired(b);
}

/// "holding_registers 5 to 8".
std::string place(const Point& point) {
  const modbus::Range taken = range(point);
  if (taken.count() == 1) return fmt::format("{} {}", to_string(point.table), taken.start());
  return fmt::format("{} {} to {}", to_string(point.table), taken.start(), taken.last());
}

void report(const DraftPoint& draft, const DraftPoint& other, const Context& context) {
  std::string what =
      fmt::format("{} ({}) overlaps {} ({}, line {})", shown(draft.point.name), place(draft.point),
                  shown(other.point.name), place(other.point), other.address_at.line);
  const Problems::Notes notes{{other.address_at, "the other is here"}};
  if (tolerable(draft.point, other.point))
    context.problems.warning(draft.address_at, std::move(what), "remove one of the two if that is not meant",
                             notes);
  else
    context.problems.error(draft.address_at, std::move(what), "give one of the two another address", notes);
}

/// A status word, and a bit or byte of it that has a name of its own.
bool is_word_and_part(const Point& word, const Point& part) {
  const codec::Type type = word.format.type;
  return !is_partial(word) && is_partial(part) && type != codec::Type::STRING && !codec::is_float(type);
}

/// One that is only read and one that is only written, or a word and its parts of which one side is only
/// read.
bool is_meant(const Point& a, const Point& b) {
  if (is_wired(a) || is_wired(b) || (is_writable(a) && is_writable(b))) return false;
  return is_readable(a) != is_readable(b) || is_word_and_part(a, b) || is_word_and_part(b, a);
}

/// The owners of the bits of each address so far: of whole registers, and of parts of them. Writers are
/// listed a second time on their own, because a reader may have taken their bits before them. In each list
/// the claims on one address share no bits, so there are at most sixteen, and the whole check stays linear in
/// the number of registers.
class Claims {
 public:
  /// Takes the bits that are free. Returns an owner of the others: one with which sharing is an error, if
  /// there is such an owner. An owner with which it is meant is not returned.
  const DraftPoint* take(const DraftPoint& draft) {
    const bool is_part = is_partial(draft.point);
    const DraftPoint* found = take(draft, is_part ? parts_ : wholes_);
    found = worse(draft, found, look(draft, is_part ? wholes_ : parts_));
    return worse(draft, found, is_writable(draft.point) ? take(draft, writers_) : nullptr);
  }

 private:
  using ByAddress = std::unordered_map<std::uint32_t, std::vector<Claim>>;

  static const DraftPoint* worse(const DraftPoint& draft, const DraftPoint* a, const DraftPoint* b) {
    if (a == nullptr || b == nullptr) return a == nullptr ? b : a;
    return tolerable(draft.point, a->point) ? b : a;
  }

  static std::uint32_t key(Table table, std::uint32_t address) {
    return static_cast<std::uint32_t>(index(table)) << 16U | address;
  }

  static const DraftPoint* take(const DraftPoint& draft, ByAddress& taken_so_far) {
    const DraftPoint* found = nullptr;
    const std::uint16_t mask = codec::mask(draft.point.format);
    const modbus::Range taken = range(draft.point);
    for (std::uint32_t address = taken.start(); address < taken.end(); ++address) {
      auto& claims = taken_so_far[key(draft.point.table, address)];
      std::uint16_t free = mask;
      for (Claim& claim : claims) {
        if ((claim.mask & mask) == 0) continue;
        free = static_cast<std::uint16_t>(free & ~claim.mask);
        if (!is_meant(draft.point, claim.owner->point)) found = worse(draft, found, claim.owner);
      }
      if (free != 0) claims.push_back({free, &draft});
    }
    return found;
  }

  static const DraftPoint* look(const DraftPoint& draft, const ByAddress& taken_so_far) {
    const DraftPoint* found = nullptr;
    const std::uint16_t mask = codec::mask(draft.point.format);
    const modbus::Range taken = range(draft.point);
    for (std::uint32_t address = taken.start(); address < taken.end(); ++address) {
      const auto claims = taken_so_far.find(key(draft.point.table, address));
      if (claims == taken_so_far.end()) continue;
      for (const Claim& claim : claims->second)
        if ((claim.mask & mask) != 0 && !is_meant(draft.point, claim.owner->point))
          found = worse(draft, found, claim.owner);
    }
    return found;
  }

  ByAddress wholes_;
  ByAddress parts_;
  ByAddress writers_;
};

}  // namespace

void check_lines(const DraftPoints& points, const Context& context) {
  std::unordered_map<std::string, const DraftPoint*> first;
  for (const DraftPoint& draft : points) {
    std::string key = hardware(draft.point);
    if (key.empty()) continue;
    const auto [found, is_new] = first.emplace(std::move(key), &draft);
    const std::string_view kind = is_analogue(draft.point) ? "channel" : "line";
    if (!is_new)
      context.problems.error(
          draft.line_at,
          fmt::format("the {}{} of {} is already that of {} (line {})", kind == "line" ? "GPIO " : "", kind,
                      shown(draft.point.name), shown(found->second->point.name), found->second->line_at.line),
          fmt::format("give each point a {} of its own", kind),
          {{found->second->line_at, "the other is here"}});
  }
}

std::uint16_t most_in_a_read(Table table, const Limits& limits) {
  return holds_bits(table) ? limits.read_bits : limits.read_registers;
}

void check_sizes(const DraftPoints& points, const Limits& limits, const Context& context) {
  for (const DraftPoint& draft : points) {
    if (!draft.placed) continue;
    const bool bits = holds_bits(draft.point.table);
    const std::uint16_t most_read = most_in_a_read(draft.point.table, limits);
    const bool too_long_to_read = is_readable(draft.point) && range(draft.point).count() > most_read;
    if (too_long_to_read || !is_writable(draft.point))
      check_size(draft, bits ? "read_bits" : "read_registers", most_read, context);
    else
      check_size(draft, bits ? "write_bits" : "write_registers",
                 bits ? limits.write_bits : limits.write_registers, context);
  }
}

void warn_of_modicon_numbers(const DraftPoints& points, const Context& context) {
  const DraftPoint* first = nullptr;
  std::size_t alike = 0;
  std::size_t others = 0;
  for (const DraftPoint& draft : points) {
    if (!draft.placed || draft.addressless || draft.point.table == Table::coils) continue;
    const bool similar = looks_like_modicon(draft.point.address, draft.point.table);
    ++(similar ? alike : others);
    if (similar && first == nullptr) first = &draft;
  }
  if (alike <= others) return;
  const unsigned number = first->point.address;
  context.problems.warning(
      first->address_at,
      fmt::format("{} is read as the zero-based address {}, not as Modicon number {} of {} (address {})",
                  number, number, number % 10000, to_string(first->point.table), number % 10000 - 1),
      "write 'addressing: zero_based' at the top if that is meant, otherwise 'addressing: modicon'");
}

void check_overlaps(const DraftPoints& points, const Context& context) {
  Claims claims;
  for (const DraftPoint& draft : points) {
    if (!draft.placed) continue;
    if (const DraftPoint* other = claims.take(draft)) report(draft, *other, context);
  }
}

void check_unreadable(const Areas& areas, const DraftPoints& points, const Limits& limits,
                      const Context& context) {
  for (const Area& area : areas) {
    for (const DraftPoint& draft : points) {
      const Point& point = draft.point;
      if (!draft.placed || !needs_answers(point, limits) || point.table != area.table ||
          !read_range(point).overlaps(area.range))
        continue;
      context.problems.error(
          draft.address_at,
          fmt::format("{} is read {}from an area that is 'unreadable' (line {})", shown(point.name),
                      is_readable(point) ? "" : "before it is written ", area.at.line),
          is_readable(point) ? "give it 'access: write', or make the area smaller" : for_itself,
          {{area.at, "the area is here"}});
    }
  }
}

void check_broadcast(const Reader& top, const DraftPoints& points, const Map& head, const Context& context) {
  if (!head.connection.is_broadcast()) return;
  if (head.coupler_watchdog.present())
    context.problems.error(top.find("watchdog")->key_at,
                           "the device's 'watchdog' needs answers, but 'unit: 0' is a broadcast",
                           "remove 'watchdog', or give the map the device's own unit, 1 to 247");
  for (const std::string_view key : {"tools", "axes"})
    if (const Entry* given = top.find(key))
      context.problems.error(
          given->key_at, fmt::format("'{}' need answers, but 'unit: 0' is a broadcast", key),
          fmt::format("remove '{}', or give the map the device's own unit, 1 to 247", key));
  for (const DraftPoint& draft : points)
    if (needs_answers(draft.point, head.limits))
      context.problems.error(
          draft.name_at,
          fmt::format("{} needs to be read, but 'unit: 0' is a broadcast, which nobody answers",
                      shown(draft.point.name)),
          is_readable(draft.point) ? "give it 'access: write', or the map the device's own unit, 1 to 247"
                                   : for_itself);
}

void check_reserved(const Areas& areas, const DraftPoints& points, const Context& context) {
  for (const Area& area : areas) {
    for (const DraftPoint& draft : points) {
      const Point& point = draft.point;
      if (!draft.placed || point.table != area.table || !range(point).overlaps(area.range)) continue;
      context.problems.error(draft.address_at,
                             fmt::format("{} ({} {}) is in the reserved area {} to {} (line {})",
                                         shown(point.name), to_string(point.table), point.address,
                                         area.range.start(), area.range.last(), area.at.line),
                             draft.addressless
                                 ? "make the area smaller: the lock has given the address before"
                                 : "give it an address outside, or make the area smaller",
                             {{area.at, "the area is here"}});
    }
  }
}

}  // namespace coupler::loader
