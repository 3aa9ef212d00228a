// SPDX-License-Identifier: Apache-2.0
// What a reader says of a key that its section does not have.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "coupler/codec/type_name.hpp"
#include "coupler/map/loader/reader.hpp"
#include "coupler/map/loader/scalar.hpp"
#include "coupler/map/loader/synonyms.hpp"
#include "coupler/map/nearest.hpp"

namespace coupler::loader {
namespace {

/// The key is known elsewhere, but may still be a typing mistake for one that is known here.
std::string or_slip(std::string_view word, const std::vector<std::string_view>& candidates) {
  const std::string_view near = nearest(word, candidates);
  const bool one_letter = !near.empty() && edit_distance(lower(word), near) == 1;
  return one_letter ? fmt::format("; or did you mean '{}'?", near) : std::string();
}

/// "the map, a coil"
std::string places(Section sections) {
  std::string text;
  for (unsigned bit = 1; bit <= static_cast<unsigned>(Section::last); bit <<= 1U)
    if (overlap(sections, static_cast<Section>(bit)))
      text += fmt::format("{}{}", text.empty() ? "" : ", ", describe(static_cast<Section>(bit)));
  return text;
}

constexpr Section any_point =
    Section::coil | Section::discrete_input | Section::input_register | Section::holding_register;

/// A key of another section that the word is a slip of; nullptr if there is none.
const Key* slip_of_another_section(std::string_view word) {
  constexpr Section large =
      Section::map | Section::mapping | any_point;  // 'valve' is not 'value' of a deadman
  for (const Key& key : all_keys())
    if (overlap(key.sections, large) && is_slip(word, key.name)) return &key;
  return nullptr;
}

}  // namespace

void Reader::misplaced(const Entry& entry, Section elsewhere) const {
  // A point's key that other points have belongs nowhere else; others only stand in the wrong place.
  constexpr Section of_a_table = any_point | Section::coil_line | Section::input_line;
  const bool of_points = overlap(section_, of_a_table) && overlap(elsewhere, of_a_table);
  const std::string slip = or_slip(entry.key, key_names(section_));
  // In 'mapping', a key of the map is indented too far, whatever else has a key of that name.
  const bool of_map =
      elsewhere == Section::map || (section_ == Section::mapping && overlap(elsewhere, Section::map));
  const std::string where = of_map                          ? "at the top of the map"
                            : elsewhere == Section::mapping ? "below 'mapping'"
                                                            : std::string();
  std::string remedy;
  if (const Synonym* synonym = find_synonym(entry.key, section_))
    remedy = synonym->remedy;
  else if (of_points || !slip.empty())
    remedy = fmt::format("remove it; it is a key of {}{}", places(elsewhere), slip);
  else if (!where.empty())
    remedy = fmt::format("write it {}", where);
  else
    remedy = fmt::format("write it where it belongs, or remove it; it is a key of {}", places(elsewhere));
  // ros-modbus-device-driver's users may say of a bit what it is.
  const bool is_true = context_.foreign && entry.key == "type" && of_points &&
                       codec::parse_type(entry.text) == codec::Type::BOOL;
  context_.problem(context_.served || is_true, entry.key_at,
                   fmt::format("'{}' does not apply to {}", entry.key, describe(section_)),
                   context_.unless_served(std::move(remedy)));
}

void Reader::unknown(const Entry& entry) {
  if (context_.problems.is_full()) {  // a remedy would take time for nobody
    if (!context_.served && !context_.foreign) context_.problems.error(entry.key_at, "unknown key", "");
    return;
  }
  const Section elsewhere = sections_with(entry.key);
  if (elsewhere != Section::none) return misplaced(entry, elsewhere);
  const auto here = key_names(section_);
  const std::string_view near = nearest(entry.key, here);
  const bool slip = !near.empty();
  if (slip && !context_.served) misspelt_.push_back(near);
  const Key* other = slip ? nullptr : slip_of_another_section(entry.key);
  const Synonym* synonym = slip ? nullptr : find_synonym(entry.key, section_);
  const bool is_point = section_ == Section::mapping && !slip && synonym == nullptr &&
                        (entry.kind == Entry::Kind::scalar || child(entry, "address") != nullptr);
  std::string remedy;
  if (slip)
    remedy = fmt::format("did you mean '{}'?", near);
  else if (synonym != nullptr)
    remedy = synonym->remedy;
  else if (is_point)
    remedy = fmt::format("a point stands in its table: write it below one of {}", fmt::join(here, ", "));
  else if (other != nullptr)
    remedy = fmt::format("did you mean '{}', a key of {}?", other->name, places(sections_with(other->name)));
  else
    remedy = or_update(fmt::format("write one of {}; otherwise remove it", fmt::join(here, ", ")));
  const bool ours = slip || is_point || other != nullptr || (synonym != nullptr && !synonym->harmless);
  context_.problem(context_.served || (context_.foreign && !ours), entry.key_at,
                   fmt::format("unknown key {} of {}", shown(entry.key), describe(section_)),
                   context_.unless_served(std::move(remedy)));
}

}  // namespace coupler::loader
