// SPDX-License-Identifier: Apache-2.0
// A generated client whose certificates are not in its map, but where the program says.
#include <gmock/gmock.h>

#include <sys/stat.h>

#include <filesystem>
#include <fstream>

#include "test/host/client/pump_client_fixture.hpp"
#include "test/host/modbus/tls_front.hpp"

namespace coupler::client {
namespace {

using namespace std::chrono_literals;
using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

struct ClientTls : ::testing::Test {
  ClientTls() {
    std::string form = (std::filesystem::temp_directory_path() / "client-tls-XXXXXX").string();
    folder = ::mkdtemp(form.data());
    const Credentials own = tls::credentials_of(tls::test_client());
    const std::pair<const char*, const std::string*> files[] = {
        {"own.pem", &own.certificate}, {"own.key", &own.key}, {"ca.pem", &own.ca}};
    for (const auto& [name, text] : files) std::ofstream(folder / name) << *text;
    EXPECT_EQ(::chmod((folder / "own.key").c_str(), 0600), 0);
    options.address = "127.0.0.1";
    options.port = front.port();
    options.on_report = [this](Level, const std::string& text) { reports.add(text); };
  }
  ~ClientTls() override { std::filesystem::remove_all(folder); }
  std::string path(const char* name) const { return (folder / name).string(); }

  host::test::ModbusServer server;
  host::test::TlsFront front{server.port(), tls::credentials_of(tls::test_node())};
  std::filesystem::path folder;
  Options options;
  Reports reports;
};

TEST_F(ClientTls, The_options_take_the_place_of_what_the_map_does_not_say) {
  options.tls = {path("own.pem"), path("own.key"), path("ca.pem"), "press", {}, {}};
  maps::pump::Client pump{options};
  pump.connect();
  EXPECT_TRUE(pump.wait_online(20s));
}

TEST_F(ClientTls, What_is_missing_is_named) {
  options.tls.certificate = path("own.pem");
  options.tls.key = path("own.key");
  maps::pump::Client pump{options};
  EXPECT_THAT(reports.texts, ElementsAre(AllOf(HasSubstr("TLS needs 'ca', too"), HasSubstr("Options::tls"))));
}

TEST_F(ClientTls, An_address_with_TLS_needs_certificates) {
  options.address = "tls://127.0.0.1";
  maps::pump::Client pump{options};
  EXPECT_THAT(reports.texts, ElementsAre(HasSubstr("there are no certificates for TLS")));
}

TEST_F(ClientTls, A_pin_that_is_none_is_named) {
  options.tls = {path("own.pem"), path("own.key"), {}, {}, "sha256:12", {}};
  maps::pump::Client pump{options};
  EXPECT_THAT(reports.texts, ElementsAre(HasSubstr("'sha256:12' is no pin")));
}

}  // namespace
}  // namespace coupler::client
