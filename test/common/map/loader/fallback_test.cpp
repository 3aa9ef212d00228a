// SPDX-License-Identifier: Apache-2.0
// What the table of keys says of an absent key, and editors show, is what the loader does.
#include <gtest/gtest.h>

#include "coupler/map/loader/keys.hpp"
#include "test/common/map/loader/loaded.hpp"
#include "test/generate/same_map.hpp"

namespace coupler::loader {
namespace {

/// A map in which "@" is where a key of the section may stand.
struct Place {
  Section section;
  std::string_view map;
};
constexpr Place places[] = {
    {Section::map, "name: a\n@\nmapping: {coils: {b: {address: 0, line: X}}}\n"},
    {Section::limits, "name: a\nlimits: {@}\nmapping: {coils: {b: 0}}\n"},
    {Section::watchdog, "name: a\nwatchdog: {timeout: 1s, @}\nmapping: {coils: {b: 0}}\n"},
    {Section::security,
     "name: a\nsecurity: {roles: {b: {}}, certificate: c, key: d, ca: e, @}\nmapping: {coils: {f: 0}}\n"},
    {Section::role, "name: a\nsecurity: {roles: {b: {@}}, plain: b}\nmapping: {coils: {c: 0}}\n"},
    {Section::serial, "name: a\nserial: {device: /dev/ttyUSB0, @}\nmapping: {coils: {b: 0}}\n"},
    {Section::defaults,
     "name: a\ndefaults: {@}\nmapping: {holding_registers: {b: {address: 0, type: INT}}}\n"},
    {Section::wire,
     "name: a\nmapping: {coils: {b: 0}, discrete_inputs: {c: 0}}\nsim: [{from: b, to: c, @}]\n"},
    {Section::tool,
     "name: a\ntools: {b: {close: c, open: d, closed: e, opened: f, holds: g, @}}\n"
     "mapping: {coils: {c: 0, d: 1}, discrete_inputs: {e: 0, f: 1, g: 2}}\n"},
    {Section::positions,
     "name: a\ntools: {b: {close: c, travel: 1s, positions: {@}}}\nmapping: {coils: {c: 0}}\n"},
    {Section::edge,
     "name: a\nmapping: {discrete_inputs: {b: {address: 0, line: X}}, "
     "coils: {c: {address: 0, latched: {of: b, @}}}}\n"},
    {Section::scale, "name: a\nmapping: {input_registers: {b: {address: 0, type: INT, scale: {@}}}}\n"},
    {Section::coil, "name: a\nmapping: {coils: {b: {address: 0, line: X, @}}}\n"},
    {Section::coil_line, "name: a\nmapping: {coils: {b: {address: 0, line: {name: X, @}}}}\n"},
    {Section::discrete_input, "name: a\nmapping: {discrete_inputs: {b: {address: 0, line: X, @}}}\n"},
    {Section::input_line, "name: a\nmapping: {discrete_inputs: {b: {address: 0, line: {name: X, @}}}}\n"},
    {Section::input_register, "name: a\nmapping: {input_registers: {b: {address: 0, type: INT, @}}}\n"},
    {Section::holding_register, "name: a\nmapping: {holding_registers: {b: {address: 0, type: INT, @}}}\n"},
};

MapPtr with(std::string text, const std::string& key_and_value) {
  return test::load_clean(text.replace(text.find('@'), 1, key_and_value));
}

/// The place as the key needs it: texts have keys of their own, and a deadband is for `publish: on_change`.
std::string made_for(const Key& key, const Place& place) {
  std::string map(place.map);
  constexpr std::string_view number = "type: INT, ";
  if (!applies_to(key, "INT"))
    map.replace(map.find(number), number.size(),
                applies_to(key, "REAL") ? "type: REAL, " : "type: STRING, length: 2, ");
  if (key.name == "deadband") map.replace(map.find('@'), 1, "publish: on_change, @");
  return map;
}

TEST(Fallback, A_key_with_it_is_as_good_as_none) {
  std::size_t tried = 0;
  for (const Key& key : all_keys())
    for (const Place& place : places) {
      if (key.fallback.empty() || !overlap(key.sections, place.section)) continue;
      SCOPED_TRACE(std::string(describe(place.section)) + ": " + std::string(key.name));
      const std::string map = made_for(key, place);
      const MapPtr absent = with(map, "");
      const MapPtr present = with(map, std::string(key.name) + ": " + std::string(key.fallback));
      Map same_text = present->map();
      same_text.text = absent->map().text;
      same_text.text_crc = absent->map().text_crc;
      testing::expect_same(absent->map(), same_text);
      ++tried;
    }
  EXPECT_GT(tried, 60U);
}

TEST(Fallback, Every_key_that_has_one_is_tried) {
  Section covered = Section::none;
  for (const Place& place : places) covered = covered | place.section;
  for (const Key& key : all_keys())
    EXPECT_TRUE(key.fallback.empty() || overlap(key.sections, covered)) << key.name;
}

}  // namespace
}  // namespace coupler::loader
