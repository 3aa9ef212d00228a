// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/client/set_result.hpp"

#include <cstddef>
#include <memory>
#include <mutex>
#include <utility>

#include <fmt/format.h>

namespace coupler::client {
namespace {

using host::WriteResult;

/// The text begins with the name, if there is one.
SetResult copy(const WriteResult& result, std::string_view name) {
  std::string text = to_string(result);
  if (!name.empty()) text = fmt::format("{}: {}", name, text);
  return {result.outcome, result.exception, std::move(text)};
}

/// The promise of one write or more. Their results may come from two threads.
class Promise {
 public:
  explicit Promise(std::size_t writes) : missing_(writes) {}
  PendingWrite future() { return promise_.get_future(); }

  void add(const WriteResult& result, std::string_view name) {
    const std::lock_guard lock(mutex_);
    if (result.outcome != WriteResult::Outcome::ok && !failure_) failure_ = copy(result, name);
    if (--missing_ == 0) promise_.set_value(failure_ ? *std::move(failure_) : copy({}, {}));
  }

 private:
  std::mutex mutex_;
  std::size_t missing_;
  std::optional<SetResult> failure_;
  std::promise<SetResult> promise_;
};

/// The listener of one of them. It deletes itself once it has its result: nobody else knows when that is.
class Part final : public host::WriteListener {
 public:
  /// The name, which may be empty, must be valid until then.
  Part(std::shared_ptr<Promise> whole, std::string_view name) : whole_(std::move(whole)), name_(name) {}
  void on_result(const WriteResult& result) override {
    const std::unique_ptr<Part> ends(this);
    whole_->add(result, name_);
  }

 private:
  std::shared_ptr<Promise> whole_;
  std::string_view name_;
};

}  // namespace

PendingWrite refused(std::string_view why, std::string_view name) {
  std::promise<SetResult> known;
  known.set_value(copy({SetResult::Outcome::refused, std::nullopt, why}, name));
  return known.get_future();
}

PendingWrite listen_to(host::Write& write) {
  const auto whole = std::make_shared<Promise>(1);
  write.listener = std::make_unique<Part>(whole, std::string_view()).release();
  return whole->future();
}

PendingWrite listen_to_all(std::vector<host::Write>& writes, const Map& map) {
  const auto whole = std::make_shared<Promise>(writes.size());
  std::vector<std::unique_ptr<Part>> parts;
  parts.reserve(writes.size());
  for (const host::Write& write : writes)
    parts.push_back(std::make_unique<Part>(whole, map.points[write.point].name));
  for (std::size_t i = 0; i < writes.size(); ++i) writes[i].listener = parts[i].release();
  return whole->future();
}

}  // namespace coupler::client
