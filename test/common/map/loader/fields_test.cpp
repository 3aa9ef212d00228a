// SPDX-License-Identifier: Apache-2.0
#include "coupler/map/fields.hpp"

#include <string_view>
#include <tuple>
#include <type_traits>
#include <utility>
#include <vector>

#include <gmock/gmock.h>

#include "coupler/map/loader/keys.hpp"

namespace coupler::loader {
namespace {

/// The keys of fields_of(Struct) that the section does not have: the reader would pass over them.
template <class Struct>
std::vector<std::string_view> unknown_keys(Section section) {
  std::vector<std::string_view> unknown;
  const Struct object{};
  for_each_field(object, [&](const auto& field, const auto&) {
    if (find_key(field.key, section) == nullptr) unknown.push_back(field.key);
  });
  return unknown;
}

/// How many members an aggregate has.
struct Anything {
  template <class T>
  operator T() const;  // NOLINT(google-explicit-constructor)
};
template <class Struct, class Tried, class... Members>
struct MemberCount : std::integral_constant<std::size_t, sizeof...(Members) - 1> {};
template <class Struct, class... Members>
struct MemberCount<Struct, std::void_t<decltype(Struct{std::declval<Members>()...})>, Members...>
    : MemberCount<Struct, void, Members..., Anything> {};
template <class Struct>
constexpr std::size_t members = MemberCount<Struct, void>::value;
template <class Struct>
constexpr std::size_t fields = std::tuple_size_v<decltype(fields_of(static_cast<Struct*>(nullptr)))>;

template <class Struct>
constexpr bool lists_all = fields<Struct> == members<Struct>;

static_assert(lists_all<Connection> && lists_all<Serial> && lists_all<Polling> && lists_all<Limits> &&
                  lists_all<Watchdog> && lists_all<SimWire> && lists_all<Line> && lists_all<EdgeOf> &&
                  lists_all<JointPositions> && lists_all<codec::Scale> && lists_all<Iio> && lists_all<Pwm> &&
                  lists_all<Bounds>,
              "A member without its key in coupler/map/fields.hpp");
static_assert(fields<HostOptions> + 1 == members<HostOptions>, "The one more is deadman");
static_assert(fields<Tool> + 1 == members<Tool>, "The one more is the name");
static_assert(fields<Axis> + 1 == members<Axis>, "The one more is the name");
static_assert(fields<Service> + 3 == members<Service>, "The three more are allow, watchdog and port");

TEST(Fields, The_key_table_has_each_of_their_keys) {
  using ::testing::IsEmpty;
  EXPECT_THAT(unknown_keys<Map>(Section::map), IsEmpty());
  EXPECT_THAT(unknown_keys<Connection>(Section::map), IsEmpty());
  EXPECT_THAT(unknown_keys<Polling>(Section::map), IsEmpty());
  EXPECT_THAT(unknown_keys<Service>(Section::map), IsEmpty());
  EXPECT_THAT(unknown_keys<Serial>(Section::serial), IsEmpty());
  EXPECT_THAT(unknown_keys<Limits>(Section::limits), IsEmpty());
  EXPECT_THAT(unknown_keys<Watchdog>(Section::watchdog), IsEmpty());
  EXPECT_THAT(unknown_keys<SimWire>(Section::wire), IsEmpty());
  EXPECT_THAT(unknown_keys<Tool>(Section::tool), IsEmpty());
  EXPECT_THAT(unknown_keys<Axis>(Section::axis), IsEmpty());
  EXPECT_THAT(unknown_keys<JointPositions>(Section::positions), IsEmpty());
  EXPECT_THAT(unknown_keys<HostOptions>(Section::defaults), IsEmpty());
  EXPECT_THAT(unknown_keys<HostOptions>(Section::holding_register), IsEmpty());
  EXPECT_THAT(unknown_keys<Bounds>(Section::holding_register), IsEmpty());
  EXPECT_THAT(unknown_keys<Line>(Section::coil_line | Section::input_line), IsEmpty());
  EXPECT_THAT(unknown_keys<EdgeOf>(Section::edge), IsEmpty());
  EXPECT_THAT(unknown_keys<codec::Scale>(Section::scale), IsEmpty());
  EXPECT_THAT(unknown_keys<Iio>(Section::iio), IsEmpty());
  EXPECT_THAT(unknown_keys<Pwm>(Section::pwm), IsEmpty());
}

TEST(Fields, A_key_without_a_value_in_the_map_has_the_default_that_the_key_table_names) {
  const HostOptions options{};
  for_each_field(options, [](const auto& field, const auto& value) {
    const Key& key = *find_key(field.key, Section::defaults);
    EXPECT_EQ(key.fallback.empty() ? written(value) : key.fallback, written(value)) << field.key;
  });
}

}  // namespace
}  // namespace coupler::loader
