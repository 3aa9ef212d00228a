// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <optional>

#include "coupler/host/client/point.hpp"
#include "test/random/values.hpp"

namespace coupler::random {

/// The host's side of a map. Points are indices into Map::points.
class ClientEnd {
 public:
  virtual ~ClientEnd() = default;
  virtual client::Session& session() = 0;
  virtual client::PendingWrite set(std::uint32_t point, const Values& values) = 0;
  /// nullopt: there is no good value now.
  virtual std::optional<Values> get(std::uint32_t point) = 0;
};

/// A generated client.
template <class Client>
class GeneratedClient : public ClientEnd {
 public:
  explicit GeneratedClient(client::Options options) : client_(std::move(options)) {
    client_.each_point([this](std::string_view, auto& point) { add(point); });
  }
  client::Session& session() override { return client_; }
  client::PendingWrite set(std::uint32_t point, const Values& values) override { return set_[point](values); }
  std::optional<Values> get(std::uint32_t point) override { return get_[point](); }

 private:
  template <class T>
  void add(client::Input<T>& point) {
    set_.emplace_back();
    add_get(point);
  }
  template <class T>
  void add(client::Output<T>& point) {
    add_set(point);
    add_get(point);
  }
  template <class T>
  void add(client::Command<T>& point) {
    add_set(point);
    get_.emplace_back();
  }
  template <class P>
  void add_set(P& point) {
    set_.emplace_back([&point](const Values& values) {
      return point.set(Elements<typename P::value_type>::typed(values.data()));
    });
  }
  template <class T>
  void add_get(const client::Input<T>& point) {
    get_.emplace_back([&point]() -> std::optional<Values> {
      const auto reading = point.get();
      if (!reading || reading->quality != client::Quality::good) return std::nullopt;
      return Elements<T>::values(reading->value);
    });
  }

  Client client_;
  std::vector<std::function<client::PendingWrite(const Values&)>> set_;
  std::vector<std::function<std::optional<Values>()>> get_;
};

/// The same for a map that was loaded, which outlives it.
class RunTimeClient : public ClientEnd, private client::Session {
 public:
  RunTimeClient(const Map& map, client::Options options) : Session(map, std::move(options)), map_(map) {}
  ~RunTimeClient() override { disconnect(); }
  client::Session& session() override { return *this; }
  client::PendingWrite set(std::uint32_t point, const Values& values) override;
  std::optional<Values> get(std::uint32_t point) override;

 private:
  const Map& map_;
};

}  // namespace coupler::random
