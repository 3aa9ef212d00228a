// SPDX-License-Identifier: Apache-2.0
// Who may see the panel. No HTTP here: texts in, a verdict out.
#pragma once

#include <deque>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>

namespace coupler::host {

/// So many bits that nobody guesses, as 32 hexadecimal digits. Throws std::runtime_error if the system has
/// none.
std::string random_key();

/// Returns whether two texts are equal, in a time that does not show where they differ.
bool equal_in_constant_time(std::string_view a, std::string_view b);

/// The key stands behind `#` in the address that the terminal shows, so that no server, proxy or history of
/// requests sees it. The page trades it for a token of its own, which it shows with each request.
class Access {
 public:
  static constexpr std::size_t most_tokens = 64;

  Access() : key_(random_key()) {}
  const std::string& key() const { return key_; }

  /// A new token; empty: that is not the key. Of too many that is forgotten which was not shown for longest.
  std::string trade(std::string_view key);

  /// The holder of a token.
  struct Page {
    std::string token;
    unsigned number = 0;  ///< from 1, in the order in which the tokens were given
  };
  /// `authorization`: the header's value, "Bearer TOKEN". nullopt: nobody.
  std::optional<Page> find(std::string_view authorization);

 private:
  const std::string key_;
  std::mutex mutex_;
  std::deque<Page> pages_;  ///< the one that was shown last is the last
  unsigned given_ = 0;
};

/// Returns whether a request may have come from this panel's own page. `host` is the header; `origin` is
/// empty if there is none. `local` is the address that the connection came to. A name that somebody else's
/// DNS gives this machine is none of these, so a foreign page cannot reach the panel by it. `secure`: the
/// page is served by HTTPS.
bool is_own_page(std::string_view host, std::string_view origin, std::string_view local, int port,
                 std::string_view name, bool secure);

}  // namespace coupler::host
