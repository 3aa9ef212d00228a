// SPDX-License-Identifier: Apache-2.0
#include "coupler/json/json_text.hpp"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace coupler {
namespace {

TEST(JsonText, It_is_one_line_in_the_order_of_the_keys) {
  const nlohmann::ordered_json json{{"z", {1, 2.5}}, {"a", "°C"}, {"n", nullptr}};
  EXPECT_EQ(json_text(json), R"({"z":[1,2.5],"a":"°C","n":null})");
}

TEST(JsonText, What_is_no_text_of_Unicode_is_replaced) {
  EXPECT_EQ(json_text(nlohmann::ordered_json("a\xFF\n")), "\"a\xEF\xBF\xBD\\n\"");
}

}  // namespace
}  // namespace coupler
