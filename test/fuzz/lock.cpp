// SPDX-License-Identifier: Apache-2.0
// The lock's parser on any text: what it takes is written and read again as the same, and no place is in it
// twice.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "coupler/map/lock/lock.hpp"
#include "test/fuzz/require.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace coupler;
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  const lock::Parsed parsed = lock::parse(text, "lock");
  const auto lines = 1 + std::count(text.begin(), text.end(), '\n');
  for (const Diagnostic& diagnostic : parsed.diagnostics)
    fuzz::require(diagnostic.line >= 1 && diagnostic.line <= lines && diagnostic.column >= 1 &&
                      !diagnostic.what.empty() && !diagnostic.remedy.empty(),
                  "a diagnostic has a place, and says what is wrong and what to do");
  if (!parsed.diagnostics.empty()) return 0;

  const lock::Parsed again = lock::parse(lock::print(parsed.lock), "lock");
  fuzz::require(again.diagnostics.empty() && lock::equal(again.lock, parsed.lock),
                "what is written is read again as the same");
  for (auto entry = parsed.lock.begin(); entry != parsed.lock.end(); ++entry)
    fuzz::require(std::none_of(parsed.lock.begin(), entry,
                               [&](const lock::Entry& other) { return overlap(other.place, entry->place); }),
                  "no place is given twice");
  return 0;
}
