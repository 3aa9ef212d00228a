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

SetResult copy(const WriteResult& result) { return {result.outcome, result.exception, to_string(result)}; }

SetResult copy(const WriteResult& result, std::string_view name) {
  SetResult copied = copy(result);
  if (!name.empty()) copied.text = fmt::format("{}: {}", name, copied.text);
  return copied;
}

/// Deletes itself once it has its result: nobody else knows when that is.
class Promise final : public host::WriteListener {
 public:
  void on_result(const WriteResult& result) override {
    const std::unique_ptr<Promise> ends(this);
    promise_.set_value(copy(result));
  }
  PendingWrite future() { return promise_.get_future(); }

 private:
  std::promise<SetResult> promise_;
};

/// The promise of several writes. Their results may come from two threads.
class JointPromise {
 public:
  explicit JointPromise(std::size_t writes) : missing_(writes) {}
  PendingWrite future() { return promise_.get_future(); }

  void add(const WriteResult& result, std::string_view name) {
    const std::lock_guard lock(mutex_);
    if (result.outcome != WriteResult::Outcome::ok && !failure_) failure_ = copy(result, name);
    if (--missing_ == 0) promise_.set_value(failure_ ? *std::move(failure_) : copy(WriteResult{}));
  }

 private:
  std::mutex mutex_;
  std::size_t missing_;
  std::optional<SetResult> failure_;
  std::promise<SetResult> promise_;
};

/// Deletes itself as Promise does.
class Part final : public host::WriteListener {
 public:
  /// The name must be valid until then.
  Part(std::shared_ptr<JointPromise> whole, std::string_view name) : whole_(std::move(whole)), name_(name) {}
  void on_result(const WriteResult& result) override {
    const std::unique_ptr<Part> ends(this);
    whole_->add(result, name_);
  }

 private:
  std::shared_ptr<JointPromise> whole_;
  std::string_view name_;
};

}  // namespace

PendingWrite refused(std::string_view why, std::string_view name) {
  std::promise<SetResult> known;
  known.set_value(copy({SetResult::Outcome::refused, std::nullopt, why}, name));
  return known.get_future();
}

PendingWrite listen_to(host::Write& write) {
  auto promise = std::make_unique<Promise>();
  PendingWrite future = promise->future();
  write.listener = promise.release();
  return future;
}

PendingWrite listen_to_all(std::vector<host::Write>& writes, const Map& map) {
  const auto whole = std::make_shared<JointPromise>(writes.size());
  std::vector<std::unique_ptr<Part>> parts;
  parts.reserve(writes.size());
  for (const host::Write& write : writes)
    parts.push_back(std::make_unique<Part>(whole, map.points[write.point].name));
  for (std::size_t i = 0; i < writes.size(); ++i) writes[i].listener = parts[i].release();
  return whole->future();
}

}  // namespace coupler::client
