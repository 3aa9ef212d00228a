// SPDX-License-Identifier: Apache-2.0
#include "common/map/loader/overlap.hpp"

#include <unordered_map>
#include <vector>

#include <fmt/format.h>

namespace coupler::loader {
namespace {

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

void report(const DraftPoint& draft, const DraftPoint& other, Context& context) {
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

/// The claims on every address so far, those of writers once more: a reader may have been there before them.
/// In either list those of one address share no bits, so there are at most sixteen of them and the whole
/// check stays linear in the number of registers.
class Claims {
 public:
  /// Takes what is free and returns who had the rest: one with whom sharing is an error, if there is any.
  const DraftPoint* take(const DraftPoint& draft) {
    const DraftPoint* found = take(draft, everyone_);
    const DraftPoint* writer = is_writable(draft.point) ? take(draft, writers_) : nullptr;
    return writer != nullptr && tolerable(draft.point, found->point) ? writer : found;
  }

 private:
  using ByAddress = std::unordered_map<std::uint32_t, std::vector<Claim>>;

  static const DraftPoint* take(const DraftPoint& draft, ByAddress& taken_so_far) {
    const DraftPoint* found = nullptr;
    const std::uint16_t mask = codec::mask(draft.point.format);
    const modbus::Range taken = range(draft.point);
    for (std::uint32_t address = taken.start(); address < taken.end(); ++address) {
      auto& claims = taken_so_far[static_cast<std::uint32_t>(index(draft.point.table)) << 16U | address];
      std::uint16_t free = mask;
      for (Claim& claim : claims) {
        if ((claim.mask & mask) == 0) continue;
        free = static_cast<std::uint16_t>(free & ~claim.mask);
        if (found == nullptr || tolerable(draft.point, found->point)) found = claim.owner;
      }
      if (free != 0) claims.push_back({free, &draft});
    }
    return found;
  }

  ByAddress everyone_;
  ByAddress writers_;
};

}  // namespace

void check_overlaps(const DraftPoints& points, Context& context) {
  Claims claims;
  for (const DraftPoint& draft : points) {
    if (!draft.placed) continue;
    if (const DraftPoint* other = claims.take(draft)) report(draft, *other, context);
  }
}

}  // namespace coupler::loader
