// SPDX-License-Identifier: Apache-2.0
// What the random proof is made of.
//   random_maps maps FOLDER SEED COUNT    random_0.yaml … with the seeds from SEED on
//   random_maps ends FOLDER COUNT EACH    ends_0.cpp …, EACH maps in one, after they were generated from
#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>

#include <fmt/format.h>

#include "coupler/generate/member.hpp"
#include "coupler/map/loader/load.hpp"
#include "test/fakes/random_map.hpp"

namespace coupler::random {
namespace {

namespace fs = std::filesystem;

constexpr unsigned most_points_a_table = 5;

std::string name_of(unsigned i) { return fmt::format("random_{}", i); }

bool write(const fs::path& path, const std::string& text) {
  std::ofstream out(path, std::ios::binary);
  out << text;
  return out.flush().good();
}

bool write_maps(const fs::path& folder, unsigned seed, unsigned count) {
  for (unsigned i = 0; i < count; ++i) {
    fakes::RandomMap map(seed + i, most_points_a_table);
    if (i % 3 == 0) map.add_hardware();
    if (i % 4 == 0) map.leave_out_addresses();
    // A busy machine is late, not gone.
    if (!write(folder / (name_of(i) + ".yaml"),
               fmt::format("# seed {}\ntimeout: 60s\n{}", seed + i, map.yaml())))
      return false;
  }
  return true;
}

/// Hooks that tell what they got, and set what they are told.
std::string firmware(const std::string& name, const Map& map) {
  const std::vector<std::string> members = generate::members(map);
  std::string hooks;
  std::string cases;
  for (std::size_t i = 0; i < members.size(); ++i) {
    if (is_hooked_output(map.points[i]))
      hooks += fmt::format(
          "  bool on_{0}(decltype(argument_of(&NodeHooks::on_{0})) value) override {{ return took({1}, "
          "value); }}\n",
          members[i], i);
    if (is_set_by_firmware(map.points[i]))
      cases += fmt::format(
          "      case {1}: return "
          "set_{0}(typed<decltype(argument_of(&NodeHooks::set_{0}))>(values)).has_value();\n",
          members[i], i);
  }
  return fmt::format(
      "class Firmware_{0} : public maps::{0}::NodeHooks, public FirmwareEnd {{\n"
      "  device::Hooks& hooks() override {{ return *this; }}\n"
      "  void serving_began() override {{ if (when_serving) when_serving(); }}\n{1}"
      "  bool put(std::uint32_t point, [[maybe_unused]] const Values& values) override {{\n"
      "    switch (point) {{\n{2}      default: return false;\n    }}\n  }}\n}};\n"
      "const Registered registered_{0}({{\"{0}\", &maps::{0}::map, make_client<maps::{0}::Client>, "
      "make_firmware<Firmware_{0}>}});\n",
      name, hooks, cases);
}

bool write_ends(const fs::path& folder, unsigned count, unsigned each) {
  for (unsigned first = 0; first < count; first += each) {
    std::string includes = "#include \"test/random/subject.hpp\"\n";
    std::string code;
    for (unsigned i = first; i < std::min(count, first + each); ++i) {
      const std::string name = name_of(i);
      const LoadResult loaded = load_map_file((folder / (name + ".yaml")).string());
      if (!loaded.map) return false;
      includes += fmt::format(
          "#include \"{0}_client.cpp\"\n#include \"{0}_core.hpp\"\n#include \"{0}_hooks.hpp\"\n#include "
          "\"{0}_map.cpp\"\n",
          name);
      code += firmware(name, loaded.map->map());
    }
    const std::string text =
        fmt::format("{}namespace coupler::random {{\nnamespace {{\n{}}}\n}}\n", includes, code);
    if (!write(folder / fmt::format("ends_{}.cpp", first / each), text)) return false;
  }
  return true;
}

}  // namespace
}  // namespace coupler::random

int main(int argc, char** argv) {
  if (argc != 5) return 2;
  const std::string what = argv[1];
  const auto first = static_cast<unsigned>(std::atoi(argv[3]));
  const auto second = static_cast<unsigned>(std::atoi(argv[4]));
  if (what == "maps") return coupler::random::write_maps(argv[2], first, second) ? 0 : 1;
  if (what == "ends") return coupler::random::write_ends(argv[2], first, second) ? 0 : 1;
  return 2;
}
