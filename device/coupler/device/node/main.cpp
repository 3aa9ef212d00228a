// SPDX-License-Identifier: Apache-2.0
// coupler-node: serves a map that it reads at the start, and again at SIGHUP.
#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <system_error>
#include <utility>
#include <variant>

#include "coupler/base/standard_files.hpp"
#include "coupler/device/log/stderr_log.hpp"
#include "coupler/device/node/map_reading.hpp"
#include "coupler/device/node/options.hpp"
#include "coupler/device/node/program.hpp"
#include "coupler/device/node/reload_requests.hpp"
#include "coupler/device/node/serve_error.hpp"
#include "coupler/device/replay/replay.hpp"
#include "coupler/map/loader/load.hpp"

namespace coupler::device {
namespace {

/// The map file of a node. Its errors and warnings are logged.
class MapInput {
 public:
  /// `path` may be "-", standard input, which can be read once. The log outlives it.
  MapInput(std::string path, StderrLog& log) : path_(std::move(path)), log_(log) {}

  /// Any file will do, a pipe too.
  ReadMap first() const {
    return {[this] { return read(); }, log_.descriptor()};
  }

  /// A node that serves reads only a regular file. Others may have no end, or block.
  ReadMap again() const {
    if (path_ == "-") return {};
    const auto read = [this]() -> tl::expected<MapPtr, std::string> {
      for (const std::string& path : {path_, path_ + ".lock"})
        if (!is_regular(path)) return tell({irregular(path)});
      return this->read();
    };
    return {read, log_.descriptor()};
  }

 private:
  tl::expected<MapPtr, std::string> read() const {
    const LoadResult loaded = load_map_file(path_);
    auto told = tell(loaded.diagnostics);
    if (loaded.map != nullptr) return loaded.map;
    return told;
  }

  /// Returns the first error.
  tl::unexpected<std::string> tell(const Diagnostics& diagnostics) const {
    for (const Diagnostic& diagnostic : shortened(diagnostics)) log_.tell(diagnostic);
    const auto error = std::find_if(diagnostics.begin(), diagnostics.end(), [](const Diagnostic& diagnostic) {
      return diagnostic.severity == Diagnostic::Severity::error;
    });
    return tl::unexpected(error == diagnostics.end() ? std::string() : to_string(*error));
  }

  /// A file that does not exist, or cannot be examined, is reported when it is read.
  static bool is_regular(const std::string& path) {
    std::error_code ignored;
    const std::filesystem::file_status status = std::filesystem::status(path, ignored);
    return !std::filesystem::exists(status) || std::filesystem::is_regular_file(status);
  }
  static Diagnostic irregular(const std::string& path) {
    return {Diagnostic::Severity::error,
            path,
            0,
            0,
            "it is not a regular file",
            "a running node reads only regular files: write the map to one, or restart the node"};
  }

  std::string path_;
  StderrLog& log_;
};

int play(const Options& options, const MapPtr& map, StderrLog& log) {
  const auto played = serve_replay(options, map, log);
  if (played) return *played;
  log.fail("error: " + played.error().text);
  return played.error().exit;
}

}  // namespace
}  // namespace coupler::device

int main(int argc, char** argv) {
  using namespace coupler::device;
  coupler::open_standard_files();
  const auto options = parse_options(argc, argv, MapSource::argument);
  if (const int* status = std::get_if<int>(&options)) return *status;

  StderrLog log(std::getenv("JOURNAL_STREAM"));
  if (const auto node = std::get<Options>(options).reload; node != 0)
    return ask_to_reload(static_cast<pid_t>(node), log);
  const ReplayArguments& replay = std::get<Options>(options).replay;
  if (!replay.file.empty() && std::get<Options>(options).map.empty())
    return play(std::get<Options>(options), nullptr, log);
  const MapInput input(std::get<Options>(options).map, log);
  auto first = read_first(input.first());
  if (!first) {
    log_errors(log, first.error());
    return first.error().reason;
  }
  if (!replay.file.empty()) return play(std::get<Options>(options), first->map, log);
  const coupler::MapPtr map = first->map;
  return serve(map->map(), std::move(first->settings), std::get<Options>(options), log, input.again(),
               nullptr);
}
