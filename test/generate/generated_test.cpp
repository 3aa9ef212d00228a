// SPDX-License-Identifier: Apache-2.0
#include <fstream>
#include <iterator>

#include "beckhoff_map.hpp"
#include "coupler/map/loader/load.hpp"
#include "example_map.hpp"
#include "hard_core.hpp"
#include "hard_hooks.hpp"
#include "hard_map.hpp"
#include "manners_map.hpp"
#include "moxa_map.hpp"
#include "secure_map.hpp"
#include "shared_map.hpp"
#include "test/device/core/fake_lines.hpp"
#include "test/generate/same_map.hpp"
#include "test/support/paths.hpp"
#include "unaddressed_map.hpp"
#include "wago_map.hpp"

namespace coupler {
namespace {

MapPtr load(const std::string& path) {
  const LoadResult loaded = load_map_file(path);
  for (const Diagnostic& diagnostic : loaded.diagnostics) ADD_FAILURE() << to_string(diagnostic);
  return loaded.map;
}

std::string read(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

TEST(Generated, The_table_is_the_map_that_the_loader_reads) {
  const MapPtr loaded = load(test::in_tree("config/example-node.yaml"));
  ASSERT_TRUE(loaded);
  testing::expect_same(maps::example::map, loaded->map());
}

TEST(Generated, Everything_that_is_hard_to_write_in_cpp_survives) {
  const MapPtr loaded = load(test::in_build("test/generate/hard.yaml"));
  ASSERT_TRUE(loaded);
  testing::expect_same(maps::hard::map, loaded->map());
}

TEST(Generated, What_the_host_does_with_points_survives) {
  const MapPtr loaded = load(test::in_tree("test/generate/manners.yaml"));
  ASSERT_TRUE(loaded);
  testing::expect_same(maps::manners::map, loaded->map());
}

TEST(Generated, Roles_and_the_files_of_certificates_survive) {
  const MapPtr loaded = load(test::in_tree("test/generate/secure.yaml"));
  ASSERT_TRUE(loaded);
  ASSERT_TRUE(loaded->map().security.files.present());
  ASSERT_TRUE(loaded->map().connection.tls.present());
  testing::expect_same(maps::secure::map, loaded->map());
}

TEST(Generated, Points_that_share_an_address_keep_the_names_of_their_values) {
  const LoadResult loaded = load_map_file(test::in_tree("test/generate/shared.yaml"));
  ASSERT_TRUE(loaded.map);
  EXPECT_FALSE(loaded.diagnostics.empty()) << "the points do not overlap";
  testing::expect_same(maps::shared::map, loaded.map->map());
}

TEST(Generated, Addresses_come_from_the_lock) {
  const MapPtr loaded = load(test::in_tree("config/unaddressed.yaml"));
  ASSERT_TRUE(loaded);
  testing::expect_same(maps::unaddressed::map, loaded->map());
  const LoadResult served = load_map(maps::unaddressed::map.text, "served");
  ASSERT_TRUE(served.map);
  EXPECT_EQ(served.map->map().fingerprint, maps::unaddressed::fingerprint);
}

TEST(Generated, The_couplers_own_watchdog_survives) {
  for (const Map* map : {&maps::wago::map, &maps::beckhoff::map, &maps::moxa::map}) {
    SCOPED_TRACE(map->name);
    const MapPtr loaded = load(test::in_tree("test/generate/") + std::string(map->name) + ".yaml");
    ASSERT_TRUE(loaded);
    ASSERT_TRUE(loaded->map().coupler_watchdog.present());
    testing::expect_same(*map, loaded->map());
  }
}

TEST(Generated, The_text_is_the_file_byte_by_byte) {
  const std::string file = read(test::in_build("test/generate/hard.yaml"));
  ASSERT_GT(file.size(), 65536U);  // longer than compilers must take
  EXPECT_TRUE(maps::hard::map.text == file);
}

TEST(Generated, The_header_knows_the_fingerprint_at_compile_time) {
  static_assert(maps::example::fingerprint != maps::hard::fingerprint);
  EXPECT_EQ(maps::example::fingerprint, maps::example::map.fingerprint);
}

TEST(Generated, Hooks_of_everything_that_is_hard_to_write_in_cpp_compile) {
  maps::hard::NodeHooks hooks;
  device::Hooks& port = hooks;
  const std::vector<std::uint16_t> zero(2000);
  for (std::uint32_t i = 0; i < maps::hard::map.points.size(); ++i)
    EXPECT_TRUE(port.accept(i, zero.data())) << maps::hard::map.points[i].name;
}

/// As on a microcontroller.
class HardCore : public maps::hard::NodeCore {
 public:
  using NodeCore::NodeCore;
  std::string text;

 private:
  bool on_text(std::string_view value) override {
    text = value;
    return true;
  }
};

TEST(Generated, A_node_in_static_memory_of_everything_that_is_hard_to_write_in_cpp_compiles_and_serves) {
  device::FakeLines lines;
  HardCore node(lines);
  device::Hooks& port = node;
  const std::vector<std::uint16_t> zero(2000);
  for (std::uint32_t i = 0; i < maps::hard::map.points.size(); ++i)
    EXPECT_TRUE(port.accept(i, zero.data())) << maps::hard::map.points[i].name;

  EXPECT_TRUE(node.set_text("Tür"));
  EXPECT_FALSE(node.set_text("0123456789")) << "longer than the point";
  EXPECT_FALSE(node.set_text("面板")) << "not in latin-1";
  const Point& point = *find(maps::hard::map, "text");
  const auto index = static_cast<std::uint32_t>(&point - maps::hard::map.points.begin());
  const std::uint16_t written[] = {0xFC54, 0x0072, 0, 0, 0};  // the low byte of a register comes first
  EXPECT_TRUE(port.accept(index, written));
  EXPECT_EQ(node.text, "Tür");
}

}  // namespace
}  // namespace coupler
