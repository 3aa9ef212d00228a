// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <optional>
#include <string>

#include "coupler/device/gpio/inventory.hpp"

namespace coupler::device {
namespace {

using testing::HasSubstr;

Line named(std::string_view name) {
  Line line;
  line.name = name;
  return line;
}

Line by_offset(std::string_view chip, std::uint32_t offset) {
  Line line;
  line.chip = chip;
  line.offset = offset;
  return line;
}

class Finding : public testing::Test {
 protected:
  Inventory inventory_{{Chip{"/dev/gpiochip0", "gpiochip0", "board", {"A", "", "TWICE"}},
                        Chip{"/dev/gpiochip1", "gpiochip1", "expander", {"TWICE", "B"}}}};
};

TEST_F(Finding, A_line_is_found_by_name_or_by_chip_name_or_label_and_offset) {
  for (const Line& line : {named("B"), by_offset("gpiochip1", 1), by_offset("expander", 1)}) {
    const auto found = inventory_.find(line);
    ASSERT_TRUE(found.has_value()) << found.error();
    EXPECT_EQ(to_string(*found), "gpiochip1 line 1 (B)");
  }
}

TEST_F(Finding, A_name_that_two_lines_have_is_refused_with_both) {
  const auto found = inventory_.find(named("TWICE"));
  ASSERT_FALSE(found.has_value());
  EXPECT_THAT(found.error(), HasSubstr("gpiochip0 line 2 (TWICE) and to gpiochip1 line 0 (TWICE)"));
}

TEST(FindingByLabel, A_label_that_two_chips_have_is_refused_with_both) {
  const Inventory twins{{Chip{"/dev/gpiochip1", "gpiochip1", "expander", {"", ""}},
                         Chip{"/dev/gpiochip2", "gpiochip2", "expander", {"", ""}}}};
  const auto found = twins.find(by_offset("expander", 1));
  ASSERT_FALSE(found.has_value());
  EXPECT_EQ(found.error(),
            "the label 'expander' belongs to gpiochip1 and to gpiochip2; choose one by path or by name");
  EXPECT_EQ(to_string(twins.find(by_offset("gpiochip2", 1)).value()), "gpiochip2 line 1");
  EXPECT_THAT(twins.find(named("A")).error(), HasSubstr("write 'line: {chip: \"gpiochip1\", offset: 0}'"));
}

TEST_F(Finding, What_is_not_there_is_answered_with_what_is) {
  EXPECT_THAT(inventory_.find(named("C")).error(), HasSubstr("named on gpiochip0: 'A', 'TWICE'"));
  EXPECT_THAT(inventory_.find(by_offset("gpiochip7", 0)).error(),
              HasSubstr("gpiochip1 'expander' (2 lines)"));
  EXPECT_THAT(inventory_.find(by_offset("board", 3)).error(),
              HasSubstr("gpiochip0 has no line 3; it has lines 0 to 2"));
}

TEST_F(Finding, Where_no_line_has_a_name_the_other_way_is_told) {
  const Inventory nameless{{Chip{"/dev/gpiochip0", "gpiochip0", "board", {"", ""}}}};
  EXPECT_THAT(
      nameless.find(named("board/1")).error(),
      HasSubstr(
          "'board' (2 lines); none of their lines has a name: write 'line: {chip: \"board\", offset: 0}'"));
}

/// As the kernel does: a link is the chip that it leads to.
std::optional<Chip> read_as_the_kernel(const std::string& path) {
  return Chip{path, std::filesystem::canonical(path).filename(), "board", {"GPIO17"}};
}

/// A folder in place of /dev, with one chip and a link to it.
class Linked : public testing::Test {
 protected:
  Linked() {
    std::filesystem::create_directory(folder_);
    std::ofstream(folder_ / "gpiochip0").flush();
    std::filesystem::create_symlink("gpiochip0", folder_ / "gpiochip4");
  }
  ~Linked() override { std::filesystem::remove_all(folder_); }

  std::filesystem::path folder_ =
      std::filesystem::path(testing::TempDir()) / ("coupler-inventory-" + std::to_string(::getpid()));
};

TEST_F(Linked, A_chip_with_a_link_to_it_is_one_chip_and_found_by_either) {
  const Inventory inventory(read_as_the_kernel, folder_);
  const std::string link = folder_ / "gpiochip4";
  for (const Line& line :
       {named("GPIO17"), by_offset("board", 0), by_offset("gpiochip0", 0), by_offset(link, 0)}) {
    const auto found = inventory.find(line);
    ASSERT_TRUE(found.has_value()) << found.error();
    EXPECT_EQ(to_string(*found), "gpiochip0 line 0 (GPIO17)");
    EXPECT_EQ(found->chip->path, folder_ / "gpiochip0");
  }
}

}  // namespace
}  // namespace coupler::device
