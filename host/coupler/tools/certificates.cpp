// SPDX-License-Identifier: Apache-2.0
// coupler certificates: an authority, and what nodes and clients need of it, as files to copy.
#include <arpa/inet.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <memory>
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
#include "coupler/tools/certificate_authority.hpp"
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

/// Returns whether a certificate of the folder is the subject's and good for long, and reports that or what
/// is done about it. It is an error if the folder belongs to another subject.
tl::expected<bool, std::string> is_kept(const fs::path& own, const std::string& stem,
                                        const std::string& certificate, const tls::Subject& subject) {
  const auto before = tls::subject_of(certificate);
  if (!before)
    return tl::unexpected(
        fmt::format("{} cannot be read as a certificate; move it away", (own / (stem + ".pem")).string()));
  if (before->is_node != subject.is_node)
    return tl::unexpected(fmt::format("{} is a {} already; give the {} another name", own.string(),
                                      before->is_node ? "node" : "client",
                                      subject.is_node ? "node" : "client"));
  if (!(*before == subject)) {
    fmt::print(
        "{}: the certificate of {} stays good until it ends; revoke it if nobody is to use it any more\n",
        own.string(), what_it_is(*before));
    return false;
  }
  if (tls::is_to_be_renewed(certificate) == true) return false;
  fmt::print("{}: {}.pem is good for more than a third of its life; nothing to do\n", own.string(), stem);
  return true;
}

/// Makes a certificate and its key, unless the subject has one with more than a third of its life left. They
/// get the names that a map or a service knows already.
tl::expected<void, std::string> provide(const fs::path& folder, const tls::Subject& subject,
                                        tls::KeyKind kind, const tls::Pem& authority,
                                        const std::vector<std::string>& roles) {
  const fs::path own = folder / subject.name;
  if (auto done = make_folder(own, true); !done) return done;
  const Stems stems = stems_in(own, subject.name + (kind == tls::KeyKind::rsa ? "-rsa" : ""), ".pem");
  const std::string stem = stems.newest.value_or(stems.next);
  std::string former;
  if (stems.newest) {
    const auto certificate = read_pem_file("certificate", stem + ".pem", own.string());
    if (!certificate) return tl::unexpected(certificate.error());
    const auto kept = is_kept(own, stem, *certificate, subject);
    if (!kept) return tl::unexpected(kept.error());
    if (*kept) return {};
    auto copied = keep_former(own, stem, *certificate);
    if (!copied) return tl::unexpected(std::move(copied).error());
    former = *std::move(copied);
  }
  const auto made = tls::issue(subject, kind, authority);
  if (!made) return tl::unexpected(made.error());
  if (!fs::exists(own / "authority.pem"))  // first: who has a certificate has this
    if (auto done = write_new(own / "authority.pem", authority.certificate, false); !done) return done;
  // The key first: a call that is killed between the two leaves a certificate that the next one renews.
  if (auto done = replace(
          {{own / (stem + ".key"), made->key, true}, {own / (stem + ".pem"), made->certificate, false}});
      !done)
    return done;
  if (former.empty()) {
    fmt::print("{}: made, {}; copy the folder beside its map, and write into that:\n{}", own.string(),
               what_it_is(subject), lines_for_map(subject, stem, roles));
  } else {
    fmt::print(
        "{0}: {1}.pem and {1}.key are new, {2}; copy both to where the old ones are in use{3}. The old "
        "certificate is kept as {4}.pem\n",
        own.string(), stem, what_it_is(subject), subject.is_node ? ", and reload the node" : "", former);
  }
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
      "makes what is missing, and renews what has less than a third of its life left, in files of the same "
      "names.");
  command.callback([arguments, &exit] { exit = certificates(*arguments); });
}

}  // namespace coupler::tools
