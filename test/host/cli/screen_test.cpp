// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/cli/screen.hpp"

#include <gtest/gtest.h>

namespace coupler::cli {
namespace {

TEST(Screen, A_frame_begins_at_the_top_and_leaves_nothing_of_the_one_before) {
  EXPECT_EQ(frame({"a", "bb"}, 24), "\033[Ha\033[K\nbb\033[K\n\033[J");
}

TEST(Screen, Lines_that_fit_are_all_shown) {
  EXPECT_EQ(frame({"a", "b"}, 3).find("more"), std::string::npos);
}

TEST(Screen, Of_too_many_lines_the_last_row_says_how_many_there_are) {
  EXPECT_EQ(frame({"a", "b", "c", "d"}, 4),
            "\033[Ha\033[K\nb\033[K\n… and 2 lines more; choose points with --points\033[K\n\033[J");
}

}  // namespace
}  // namespace coupler::cli
