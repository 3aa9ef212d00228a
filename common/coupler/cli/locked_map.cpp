// SPDX-License-Identifier: Apache-2.0
#include "coupler/cli/locked_map.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "coupler/generate/output.hpp"

namespace coupler::cli {
namespace {

std::string listed(const std::vector<std::string>& names) {
  constexpr std::size_t most = 10;
  std::string text;
  for (std::size_t i = 0; i < std::min(names.size(), most); ++i)
    text += fmt::format("{}'{}'", i == 0 ? "" : ", ", names[i]);
  return names.size() > most ? fmt::format("{} and {} more", text, names.size() - most) : text;
}

}  // namespace

LoadResult load_and_lock(const std::string& path, bool locked) {
  LoadResult loaded = load_map_file(path, locked ? LockUse::exact : LockUse::renew);
  if (!loaded.map || loaded.lock.text.empty()) return loaded;
  const auto written = generate::write_if_changed(loaded.lock.path, loaded.lock.text);
  if (written) return loaded;
  loaded.diagnostics.push_back({Diagnostic::Severity::error, loaded.lock.path, 0, 0, written.error(),
                                "the map's new points get an address only where that can be kept: work in a "
                                "folder that you may write to"});
  return {nullptr, std::move(loaded.diagnostics)};
}

std::string lock_report(const NewLock& lock) {
  if (lock.text.empty()) return {};
  std::string text = fmt::format("{}: written", lock.path);
  if (!lock.allocated.empty()) text += fmt::format("; new addresses: {}", listed(lock.allocated));
  if (!lock.retired.empty()) text += fmt::format("; retired: {}", listed(lock.retired));
  text += '\n';
  if (!lock.allocated.empty() && !lock.retired.empty())
    text += fmt::format(
        "{}: a point that was only renamed can keep its address: take the lock from version control again, "
        "and "
        "write the new name over the old one\n",
        lock.path);
  return text;
}

}  // namespace coupler::cli
