// SPDX-License-Identifier: Apache-2.0
#include "coupler/tls/pem.hpp"

#include <algorithm>

#include "coupler/base/starts_with.hpp"

namespace coupler::tls {

int no_password(char*, int, int, void*) { return -1; }

BioPtr reader_of(std::string_view text) {
  return BioPtr(BIO_new_mem_buf(text.data(), static_cast<int>(text.size())));
}

std::size_t blocks_in(std::string_view pem, std::initializer_list<std::string_view> names) {
  constexpr std::string_view begin = "-----BEGIN ";
  constexpr std::string_view end = "-----";
  const auto begins_block = [&](std::string_view line) {
    if (!starts_with(line, "-----B")) return false;
    const bool is_whole = line.size() >= begin.size() + end.size() && starts_with(line, begin) &&
                          line.substr(line.size() - end.size()) == end;
    if (!is_whole) return true;
    const std::string_view name = line.substr(begin.size(), line.size() - begin.size() - end.size());
    return std::find(names.begin(), names.end(), name) != names.end();
  };
  std::size_t count = 0;
  while (!pem.empty()) {
    std::string_view line = pem.substr(0, pem.find('\n'));
    pem.remove_prefix(std::min(line.size() + 1, pem.size()));
    line = line.substr(0, line.find_last_not_of(" \t\r") + 1);
    if (begins_block(line)) ++count;
  }
  return count;
}

}  // namespace coupler::tls
