// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <utility>

#include "coupler/device/gpio/grouped_lines.hpp"
#include "test/device/core/fake_log.hpp"

namespace coupler::device {
namespace {

using modbus::Range;
using testing::ElementsAre;
using Levels = std::vector<std::uint16_t>;

class RememberingOutputs : public OutputGroup {
 public:
  explicit RememberingOutputs(std::vector<int>& levels) : levels_(levels) {}
  const std::string& name() const override { return name_; }
  int drive(Span<const int> levels) override {
    levels_.assign(levels.begin(), levels.end());
    return 0;
  }
  int read(Span<int> levels) override {
    std::copy(levels_.begin(), levels_.end(), levels.begin());
    return 0;
  }

 private:
  std::string name_ = "chip0";
  std::vector<int>& levels_;
};

/// Runs `work` in a process of its own.
template <class Work>
void in_child(Work work) {
  const pid_t child = ::fork();
  ASSERT_GE(child, 0);
  if (child == 0) ::_exit(work() ? 0 : 1);
  int status = -1;
  ASSERT_EQ(::waitpid(child, &status, 0), child);
  EXPECT_EQ(status, 0);
}

TEST(SharedLevels, What_one_process_drove_the_others_know) {
  std::vector<int> driven;
  std::vector<WiredOutputs> outputs;
  outputs.push_back({std::make_unique<RememberingOutputs>(driven),
                     {{0, Safe::hold, 0}, {1, Safe::hold, 1}, {2, Safe::on, 0}}});
  FakeLog log;
  GroupedLines lines(std::move(outputs), {}, log);

  in_child([&] { return lines.drive(Range::of(0, 2), Levels{1, 0}); });
  Levels known(3);
  EXPECT_TRUE(lines.driven(Range::of(0, 3), known));
  EXPECT_THAT(known, ElementsAre(1, 0, 0));
  EXPECT_TRUE(lines.drive_safe());
  EXPECT_THAT(driven, ElementsAre(1, 0, 1)) << "what is held is held as the other process left it";
  in_child([&] { return lines.driven(Range::of(0, 3), known) && known == Levels{1, 0, 1}; });
}

}  // namespace
}  // namespace coupler::device
