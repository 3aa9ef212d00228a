// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/client/pending_write.hpp"

#include <memory>

namespace coupler::client {
namespace {

using host::WriteResult;

SetResult copy(const WriteResult& result) { return {result.outcome, result.exception, to_string(result)}; }

/// Lives until it is told: nobody else knows how long that takes.
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

}  // namespace

PendingWrite refused(std::string_view why) {
  WriteResult result;
  result.outcome = WriteResult::Outcome::refused;
  result.why = why;
  std::promise<SetResult> told;
  told.set_value(copy(result));
  return told.get_future();
}

PendingWrite listen_to(host::Write& write) {
  auto promise = std::make_unique<Promise>();
  PendingWrite future = promise->future();
  write.listener = promise.release();
  return future;
}

}  // namespace coupler::client
