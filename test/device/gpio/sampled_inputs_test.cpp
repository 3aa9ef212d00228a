// SPDX-License-Identifier: Apache-2.0
// Inputs that are looked at, since nothing reports their edges.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cerrno>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "coupler/device/gpio/watched_inputs.hpp"
#include "coupler/map/point.hpp"
#include "test/device/gpio/line_news.hpp"

namespace coupler::device {
namespace {

using namespace std::chrono_literals;
using testing::ElementsAre;
using testing::IsEmpty;

/// Three lines that report no edges; the third one is debounced, with 10 ms.
class Samples : public testing::Test {
 protected:
  class Wires : public InputGroup {
   public:
    explicit Wires(Samples& test) : test_(test) {}
    const std::string& name() const override { return name_; }
    int read(Span<int> levels, TimePoint) override {
      ++test_.reads_;
      std::copy(test_.levels_.begin(), test_.levels_.end(), levels.begin());
      return test_.error_;
    }

   private:
    std::string name_ = "chip0";
    Samples& test_;
  };

  std::vector<LineSpec> specs() {
    debounced_.line.debounce = 10ms;
    return {{&plain_, {}, {}}, {&plain_, {}, {}}, {&debounced_, {}, {}}};
  }
  std::vector<Told> told(int ms) {
    inputs_.tell(at(ms), sink_);
    return std::exchange(sink_.all, {});
  }

  std::vector<int> levels_{0, 1, 0};
  int error_ = 0;
  int reads_ = 0;
  Point plain_{};
  Point debounced_{};
  SampledInputs inputs_{std::make_unique<Wires>(*this), specs(), at(0)};
  LineNews sink_;
};

TEST_F(Samples, They_are_looked_at_every_5_ms_and_changes_have_that_time) {
  EXPECT_THAT(told(0), IsEmpty()) << "these are their first levels";
  EXPECT_EQ(inputs_.next_change(at(0)), at(5));
  levels_ = {1, 0, 0};
  reads_ = 0;
  EXPECT_THAT(told(4), IsEmpty());
  EXPECT_EQ(reads_, 0);
  EXPECT_THAT(told(6), ElementsAre(Told(0, true, at(6)), Told(1, false, at(6))));
  EXPECT_EQ(inputs_.next_change(at(6)), at(11));
}

TEST_F(Samples, A_read_sees_the_lines_as_they_are_and_that_is_told) {
  told(0);
  levels_ = {1, 1, 0};
  std::vector<int> levels(3);
  EXPECT_EQ(inputs_.read(levels, at(1)), 0);
  EXPECT_THAT(levels, ElementsAre(1, 1, 0));
  EXPECT_EQ(inputs_.next_change(at(1)), at(1));
  EXPECT_THAT(told(2), ElementsAre(Told(0, true, at(1))));
}

TEST_F(Samples, They_can_be_debounced) {
  EXPECT_TRUE(inputs_.has_to_look()) << "though nobody asks for changes";
  EXPECT_FALSE(SampledInputs(std::make_unique<Wires>(*this), {{&plain_, {}, {}}}, at(0)).has_to_look());
  told(0);
  levels_[2] = 1;
  EXPECT_THAT(told(5), IsEmpty());
  EXPECT_THAT(told(10), IsEmpty());
  EXPECT_THAT(told(15), ElementsAre(Told(2, true, at(5))));
}

TEST_F(Samples, What_cannot_be_read_does_not_change) {
  told(0);
  levels_ = {1, 0, 1};
  error_ = ENODEV;
  EXPECT_THAT(told(5), IsEmpty());
  std::vector<int> levels(3);
  EXPECT_EQ(inputs_.read(levels, at(6)), ENODEV);
  EXPECT_THAT(told(6), IsEmpty());
}

TEST_F(Samples, Who_waits_for_changes_is_told_each_time_that_they_begin_to_fail) {
  told(0);
  for (const std::uint32_t times : {1U, 2U}) {
    error_ = EIO;
    for (int i = 0; i < 3; ++i) told(static_cast<int>(times) * 100 + 10 * i);
    EXPECT_EQ(sink_.lost_changes, times);
    error_ = 0;
    EXPECT_THAT(told(static_cast<int>(times) * 100 + 50), IsEmpty());
  }
  EXPECT_EQ(sink_.lost_changes, 2U);
  EXPECT_EQ(inputs_.next_change(at(250)), at(255)) << "and no line is in doubt any more";
}

}  // namespace
}  // namespace coupler::device
