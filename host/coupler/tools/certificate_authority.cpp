// SPDX-License-Identifier: Apache-2.0
#include "coupler/tools/certificate_authority.hpp"

#include <system_error>
#include <utility>

#include <fmt/format.h>

#include "coupler/credentials/credentials.hpp"
#include "coupler/tools/certificate_files.hpp"

namespace coupler::tools {
namespace {

namespace fs = std::filesystem;

/// Checks that the certificate in a subject's folder is from DIR/authority, which may have been put away.
/// `authority` is its certificate; empty if it is not there.
tl::expected<void, std::string> expect_authority(const fs::path& own, const std::string& authority) {
  if (!fs::exists(own / "authority.pem")) return {};
  const auto text = read_pem_file("authority's certificate", "authority.pem", own.string());
  if (!text) return tl::unexpected(text.error());
  if (!authority.empty() && text->find(authority) != std::string::npos) return {};
  const std::string other = (own.parent_path() / "authority").string();
  return tl::unexpected(
      authority.empty()
          ? fmt::format("{} is of an authority that is not here; bring back {}, or begin another folder",
                        own.string(), other)
          : fmt::format("{} is of another authority than {}; begin another folder", own.string(), other));
}

/// Both files or none.
tl::expected<void, std::string> place_authority(const fs::path& own, const tls::Pem& made) {
  const fs::path unfinished = own.parent_path() / ".authority";  // no subject has such a name
  std::error_code error;
  fs::remove_all(unfinished, error);
  if (auto done = make_folder(unfinished, true); !done) return done;
  if (auto done = write_new(unfinished / "authority.key", made.key, true); !done) return done;
  if (auto done = write_new(unfinished / "authority.pem", made.certificate, false); !done) return done;
  fs::rename(unfinished, own, error);
  if (error)
    return tl::unexpected(
        fmt::format("{} cannot be made: {}; if there is a folder without authority.pem, move it away",
                    own.string(), error.message()));
  return {};
}

}  // namespace

tl::expected<tls::Pem, std::string> authority_in(const fs::path& folder, tls::KeyKind kind,
                                                 const std::vector<tls::Subject>& subjects) {
  const fs::path own = folder / "authority";
  const bool is_there = fs::exists(own / "authority.pem");
  std::string text;
  if (is_there) {
    auto certificate = read_pem_file("authority's certificate", "authority.pem", own.string());
    if (!certificate) return tl::unexpected(std::move(certificate).error());
    text = *std::move(certificate);
  }
  for (const tls::Subject& subject : subjects)
    if (auto done = expect_authority(folder / subject.name, text); !done)
      return tl::unexpected(std::move(done).error());
  if (is_there) {
    auto key = read_pem_file("authority's key", "authority.key", own.string(), true);
    if (!key) return tl::unexpected(std::move(key).error());
    return tls::Pem{std::move(text), *std::move(key)};
  }
  fs::path place = fs::absolute(folder).lexically_normal();
  if (place.filename().empty()) place = place.parent_path();  // it was written with a slash at its end
  constexpr std::size_t longest = 48;                         // with the words before it 64 bytes at most
  auto made = tls::make_authority("Authority of " + place.filename().string().substr(0, longest), kind);
  if (!made) return made;
  if (auto done = place_authority(own, *made); !done) return tl::unexpected(std::move(done).error());
  fmt::print("{}: made; it stays here: whoever has authority.key can make clients of any role\n",
             own.string());
  return made;
}

}  // namespace coupler::tools
