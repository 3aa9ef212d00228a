// SPDX-License-Identifier: Apache-2.0
// What the dissector does is proved with tshark, on captured traffic: test/peers/dissector_test.py.
#include "coupler/tools/formats/exporters.hpp"

#include <gmock/gmock.h>

#include "coupler/map/loader/load.hpp"
#include "test/host/tools/formats/imported.hpp"

namespace coupler::test {
namespace {

using testing::HasSubstr;

formats::Export dissector_of(const std::string& text) {
  const LoadResult loaded = load_map(text, "m");
  EXPECT_NE(loaded.map, nullptr) << lines_of(loaded.diagnostics);
  return loaded.map ? formats::write_wireshark(loaded.map->map()) : formats::Export{};
}

TEST(WiresharkExport, Is_a_table_of_the_points_and_then_the_same_for_every_map) {
  const auto out = dissector_of(
      "{name: Plant/A, unit: 3, port: 1502, mapping: {holding_registers: {\n"
      "  level: {address: 4, type: REAL, order: BADC, scale: 2, units: mm, read_address: 9}}}}");
  EXPECT_THAT(
      out.text,
      HasSubstr("name = \"Plant/A\", proto = \"coupler_plant_a\", unit = 3, port = 1502, address = \"\",\n"));
  EXPECT_THAT(out.text, HasSubstr("{ name = \"level\", table = \"holding_registers\", address = 4, size = 2, "
                                  "count = 1, readable = true, "
                                  "writable = true, read_from = 9, type = \"REAL\", bits = 32, "
                                  "words_reversed = false, bytes_swapped = true, "
                                  "gain = 2, offset = 0, units = \"mm\" },\n"));
  EXPECT_THAT(out.text, testing::EndsWith(std::string(formats::wireshark_body())));
}

TEST(WiresharkExport, Has_the_address_of_the_device_and_no_name_that_has_to_be_looked_up) {
  const auto at = [](const std::string& address) {
    return dissector_of("{name: m, address: '" + address + "', mapping: {coils: {a: 0}}}").text;
  };
  EXPECT_THAT(at("192.168.1.17"), HasSubstr("address = \"192.168.1.17\","));
  EXPECT_THAT(at("fd00::8"), HasSubstr("address = \"fd00::8\","));
  EXPECT_THAT(at("press.local"), HasSubstr("address = \"\","));
}

TEST(WiresharkExport, Texts_cannot_leave_their_quotes) {
  const auto out = dissector_of(
      R"x({name: m, mapping: {coils: {a: {address: 0, description: "say \"hi\" \\ then\n--]]os.exit()"}}}})x");
  EXPECT_THAT(out.text, HasSubstr(R"x(description = "say \"hi\" \\ then\010--]]os.exit()" },)x"));
}

TEST(WiresharkExport, What_only_the_node_knows_is_told) {
  EXPECT_THAT(lines_of(dissector_of("{name: m, mapping: {coils: {a: {address: 0, line: GPIO4}, b: 1}}}")
                           .warnings.diagnostics("m")),
              HasSubstr("belong to the node and are left out: a;"));
}

TEST(WiresharkExport, A_coupler_that_speaks_RTU_is_told) {
  EXPECT_THAT(lines_of(dissector_of("{name: m, serial: {device: /dev/ttyS0}, mapping: {coils: {a: 0}}}")
                           .warnings.diagnostics("m")),
              HasSubstr("the coupler speaks RTU; capture at a gateway that translates, and give its port: "
                        "-o coupler_m.port:N"));
}

}  // namespace
}  // namespace coupler::test
