// SPDX-License-Identifier: Apache-2.0
// coupler certificates: an authority, and what nodes and clients need of it, as files to copy.
#include <arpa/inet.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <tl/expected.hpp>

#include "coupler/codec/text.hpp"
#include "coupler/credentials/credentials.hpp"
#include "coupler/map/network.hpp"
#include "coupler/map/security.hpp"
#include "coupler/tls/issue.hpp"
#include "coupler/tools/certificate_files.hpp"
#include "coupler/tools/commands.hpp"

namespace coupler::tools {
namespace {

namespace fs = std::filesystem;
using Problem = tl::unexpected<std::string>;

struct Arguments {
  std::string folder;
  std::vector<std::string> nodes;
  std::vector<std::string> clients;
  bool rsa = false;
  bool csr = false;
};

/// NAME, and what follows the first colon.
std::pair<std::string, std::string> split(const std::string& text) {
  const auto colon = text.find(':');
  if (colon == std::string::npos) return {text, {}};
  return {text.substr(0, colon), text.substr(colon + 1)};
}

/// It is a file's name, too.
bool is_name(std::string_view name) {
  const auto is_good = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-' ||
           c == '_' || c == '.';
  };
  return !name.empty() && name.size() <= 64 && name.front() != '.' && name != "authority" &&
         std::all_of(name.begin(), name.end(), is_good);
}

Problem bad_name(const std::string& name) {
  return tl::unexpected(fmt::format(
      "'{}' is no name for a certificate; use letters, digits, '-', '_' and '.', and not 'authority'", name));
}

/// An IPv6 address in the form in which a certificate shows it; others as they are.
std::string shortest(const std::string& host) {
  in6_addr address{};
  std::array<char, INET6_ADDRSTRLEN> text{};
  if (::inet_pton(AF_INET6, host.c_str(), &address) != 1) return host;
  return ::inet_ntop(AF_INET6, &address, text.data(), text.size());
}

tl::expected<tls::Subject, std::string> node_of(const std::string& text) {
  const auto [name, hosts] = split(text);
  if (!is_name(name)) return bad_name(name);
  tls::Subject subject{name, true, {}, {}};
  for (std::string_view rest = hosts; !rest.empty();) {
    const auto comma = std::min(rest.find(','), rest.size());
    subject.hosts.emplace_back(rest.substr(0, comma));
    rest.remove_prefix(std::min(comma + 1, rest.size()));
  }
  if (subject.hosts.empty()) subject.hosts.push_back(name);
  for (std::string& host : subject.hosts) {
    const auto parsed = parse_host(host);
    if (!parsed)
      return tl::unexpected(
          fmt::format("--node {}: '{}' {}; {}", text, host, parsed.error().what, parsed.error().remedy));
    host = shortest(std::string(*parsed));  // without brackets
  }
  return subject;
}

tl::expected<tls::Subject, std::string> client_of(const std::string& text) {
  auto [name, role] = split(text);
  if (!is_name(name)) return bad_name(name);
  if (role.size() > longest_role_name || !codec::is_plain_text(role))
    return tl::unexpected(
        fmt::format("--client {}: a role has 1 to 64 bytes and no control characters", name));
  return tls::Subject{name, false, {}, role};
}

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

/// Returns the authority in DIR/authority, and makes it if it is not there. Returns an error if one of the
/// subjects has a certificate of another authority.
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

/// NAME, NAME-2, NAME-3 …: the newest that has a file with this ending, and the first one that has no file.
struct Stems {
  std::optional<std::string> newest;
  std::string next;
};

Stems stems_in(const fs::path& folder, const std::string& name, const char* ending) {
  Stems stems{std::nullopt, name};
  const auto is_taken = [&](const char* with) { return fs::exists(folder / (stems.next + with)); };
  for (int number = 2; is_taken(".pem") || is_taken(".key") || is_taken(".csr"); ++number) {
    if (is_taken(ending)) stems.newest = stems.next;
    stems.next = fmt::format("{}-{}", name, number);
  }
  return stems;
}

/// Returns the lines for the map beside which the subject's folder will be, with paths from that map. For a
/// node, they let each role read everything and write nothing, which is a safe start.
std::string lines_for_map(const tls::Subject& subject, const std::string& stem,
                          const std::vector<std::string>& roles) {
  if (!subject.is_node)
    return fmt::format("tls: {{certificate: {0}/{1}.pem, key: {0}/{1}.key, ca: {0}/authority.pem}}\n",
                       subject.name, stem);
  std::string text = fmt::format(
      "security:\n  certificate: {0}/{1}.pem\n  key: {0}/{1}.key\n  ca: {0}/authority.pem\n  roles:\n",
      subject.name, stem);
  const char* hint = "  # and what it may write, as in write: [lamp, \"valve_*\"]";
  for (const std::string& role : roles)
    text += fmt::format("    {}: {{read: all}}{}\n", role, std::exchange(hint, ""));
  text += "  plain: none  # clients without TLS; name a role here while some have none\n";
  return text;
}

/// Returns the roles of the clients; "viewer" if there are none.
std::vector<std::string> roles_of(const std::vector<tls::Subject>& subjects) {
  std::vector<std::string> roles;
  for (const tls::Subject& subject : subjects)
    if (!subject.role.empty() && std::find(roles.begin(), roles.end(), subject.role) == roles.end())
      roles.push_back(subject.role);
  return roles.empty() ? std::vector<std::string>{"viewer"} : roles;
}

std::string what_it_is(const tls::Subject& subject) {
  if (subject.is_node) return fmt::format("the node {}", fmt::join(subject.hosts, ", "));
  return subject.role.empty() ? "a client without a role"
                              : fmt::format("a client with the role {}", subject.role);
}

/// Returns whether the newest certificate of the folder is the subject's and good for long, and reports that
/// or what is done about it. It is an error if the folder belongs to another subject.
tl::expected<bool, std::string> is_kept(const fs::path& own, const std::string& stem,
                                        const tls::Subject& subject) {
  const auto text = read_pem_file("certificate", stem + ".pem", own.string());
  if (!text) return tl::unexpected(text.error());
  const auto before = tls::subject_of(*text);
  if (!before) return false;
  if (before->is_node != subject.is_node)
    return tl::unexpected(fmt::format("{} is a {} already; give the {} another name", own.string(),
                                      before->is_node ? "node" : "client",
                                      subject.is_node ? "node" : "client"));
  if (*before == subject && tls::is_to_be_renewed(*text) == false) {
    fmt::print("{}: {}.pem is good for more than a third of its life; nothing to do\n", own.string(), stem);
    return true;
  }
  if (!(*before == subject))
    fmt::print("{}: {}.pem, {}, stays good until it ends; revoke it if nobody is to use it any more\n",
               own.string(), stem, what_it_is(*before));
  return false;
}

/// Makes a certificate and its key, unless the subject has one with more than a third of its life left.
tl::expected<void, std::string> provide(const fs::path& folder, const tls::Subject& subject,
                                        tls::KeyKind kind, const tls::Pem& authority,
                                        const std::vector<std::string>& roles) {
  const fs::path own = folder / subject.name;
  if (auto done = make_folder(own, true); !done) return done;
  const Stems stems = stems_in(own, subject.name + (kind == tls::KeyKind::rsa ? "-rsa" : ""), ".pem");
  if (stems.newest) {
    const auto kept = is_kept(own, *stems.newest, subject);
    if (!kept) return tl::unexpected(kept.error());
    if (*kept) return {};
  }
  const auto made = tls::issue(subject, kind, authority);
  if (!made) return tl::unexpected(made.error());
  if (!fs::exists(own / "authority.pem"))  // first: who has a certificate has this
    if (auto done = write_new(own / "authority.pem", authority.certificate, false); !done) return done;
  if (auto done = write_new(own / (stems.next + ".key"), made->key, true); !done) return done;
  if (auto done = write_new(own / (stems.next + ".pem"), made->certificate, false); !done) return done;
  fmt::print("{}: {}, {}; copy the folder beside its map, and write into that:\n", own.string(),
             stems.newest ? "made anew" : "made", what_it_is(subject));
  fmt::print("{}", lines_for_map(subject, stems.next, roles));
  return {};
}

/// A request for another authority.
tl::expected<void, std::string> ask_for(const fs::path& folder, const tls::Subject& subject,
                                        tls::KeyKind kind) {
  const fs::path own = folder / subject.name;
  if (auto done = make_folder(own, true); !done) return done;
  const Stems stems = stems_in(own, subject.name + (kind == tls::KeyKind::rsa ? "-rsa" : ""), ".csr");
  const auto made = tls::request(subject, kind);
  if (!made) return tl::unexpected(made.error());
  if (auto done = write_new(own / (stems.next + ".key"), made->key, true); !done) return done;
  if (auto done = write_new(own / (stems.next + ".csr"), made->certificate, false); !done) return done;
  fmt::print("{}: {}.csr asks for {}; the authority's answer is {}.pem\n", own.string(), stems.next,
             what_it_is(subject), stems.next);
  return {};
}

Exit certificates(const Arguments& arguments) {
  std::vector<tls::Subject> subjects;
  for (const auto& [texts, parse] :
       {std::pair(&arguments.nodes, &node_of), std::pair(&arguments.clients, &client_of)})
    for (const std::string& text : *texts) {
      auto subject = parse(text);
      if (!subject) return complain("certificates", bad_call, subject.error(), {});
      subjects.push_back(*std::move(subject));
    }
  if (subjects.empty())
    return complain("certificates", bad_call, "there is nothing to make",
                    "add --node NAME or --client NAME:ROLE");
  auto ready = make_folder(arguments.folder, false);
  if (ready) ready = lock_folder(arguments.folder);
  if (!ready) return complain("certificates", bad_input, ready.error(), {});
  const auto kind = arguments.rsa ? tls::KeyKind::rsa : tls::KeyKind::p256;
  tls::Pem authority;
  if (!arguments.csr) {
    auto found = authority_in(arguments.folder, kind, subjects);
    if (!found) return complain("certificates", bad_input, found.error(), {});
    authority = *std::move(found);
  }
  for (const tls::Subject& subject : subjects) {
    const auto done = arguments.csr ? ask_for(arguments.folder, subject, kind)
                                    : provide(arguments.folder, subject, kind, authority, roles_of(subjects));
    if (!done) return complain("certificates", bad_input, done.error(), {});
  }
  return ok;
}

}  // namespace

void add_certificates(Program& program, Exit& exit) {
  auto command = program.add_command(
      "certificates", "Make keys and certificates for nodes and clients with TLS, or renew them.");
  const auto arguments = std::make_shared<Arguments>();
  command
      .add_option("DIR", arguments->folder,
                  "Where they are kept, a folder each; it is made if it is not there")
      .required()
      .type_name("");
  command
      .add_option("--node", arguments->nodes,
                  "A node, and the DNS names and IP addresses by which clients reach it (default: its name)")
      .type_name("NAME[:HOST,…]");
  command.add_option("--client", arguments->clients, "A client, and its role").type_name("NAME[:ROLE]");
  command.add_flag(
      "--rsa", arguments->rsa,
      "Keys for peers that know no ECDSA: RSA with 3072 bits; also the authority's, if it is made now");
  command.add_flag(
      "--csr", arguments->csr,
      "Requests for an authority that the plant has, in place of certificates: new ones at each call");
  command.footer(
      "Example:\n  coupler certificates cell --node press:192.168.1.10 --client cell1:operator\nCalled "
      "again, it "
      "makes what is missing, and renews what has less than a third of its life left.");
  command.callback([arguments, &exit] { exit = certificates(*arguments); });
}

}  // namespace coupler::tools
