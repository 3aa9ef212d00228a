// SPDX-License-Identifier: Apache-2.0
#include "coupler/map/diagnostic.hpp"

#include <gtest/gtest.h>

namespace coupler {
namespace {

using Severity = Diagnostic::Severity;

TEST(Diagnostic, It_reads_as_compilers_write_it) {
  EXPECT_EQ(to_string(Diagnostic{Severity::error, "a.yaml", 7, 11, "this is wrong", "do that"}),
            "a.yaml:7:11: error: this is wrong; do that");
  EXPECT_EQ(to_string(Diagnostic{Severity::warning, "a.yaml", 1, 1, "this is odd", "look"}),
            "a.yaml:1:1: warning: this is odd; look");
}

TEST(Diagnostic, About_a_whole_file_it_has_no_place) {
  EXPECT_EQ(to_string(Diagnostic{Severity::error, "a.yaml", 0, 0, "no such file", "look"}),
            "a.yaml: error: no such file; look");
}

TEST(Diagnostic, Warnings_are_no_errors) {
  Diagnostics found{{Severity::warning, "a.yaml", 1, 1, "this is odd", "look"}};
  EXPECT_FALSE(has_errors(found));
  found.push_back({Severity::error, "a.yaml", 1, 1, "this is wrong", "do that"});
  EXPECT_TRUE(has_errors(found));
}

}  // namespace
}  // namespace coupler
