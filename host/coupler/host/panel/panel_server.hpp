// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <string>

#include <tl/expected.hpp>

#include "coupler/host/core/write.hpp"
#include "coupler/host/panel/live_values.hpp"

namespace coupler::host {

/// The place at which browsers find the page.
struct PanelAddress {
  std::string listen = "127.0.0.1";
  int port = 0;        ///< 0: any free one
  std::string name{};  ///< that browsers may call this machine besides its address; empty: none
};

/// The TLS side of HTTPS.
class PageTls;
/// Reads the files of a certificate and its key, PEM. The error is one line: which file, what is wrong, and
/// what to do; or that this build has no TLS.
tl::expected<std::shared_ptr<const PageTls>, std::string> read_page_tls(const std::string& certificate,
                                                                        const std::string& key);

/// The actions of a panel besides showing values. Threads of the server make the calls.
class PanelDevice {
 public:
  virtual ~PanelDevice() = default;
  /// The first page looks, or the last one has left. One call at a time.
  virtual void look(bool /*anybody*/) {}
  /// Returns whether pages may write.
  virtual bool writes() const { return false; }
  /// `value`: as parse_value() takes it. It is written within 3 s, or not at all. Waits for the outcome.
  /// `page`: its number, from 1.
  virtual WriteTicket::Outcome write(unsigned page, const std::string& point, const std::string& value);
  /// Nobody is left of those who have written.
  virtual void writers_left() {}
};

/// Serves a page with what a device has at the moment, until it is destroyed.
class PanelServer {
 public:
  /// `tls`: null for HTTP. `points`: panel_points(). Everything given by reference must outlive it. Error: it
  /// cannot listen there.
  static tl::expected<std::unique_ptr<PanelServer>, std::string> start(const PanelAddress& address,
                                                                       std::shared_ptr<const PageTls> tls,
                                                                       std::string points, LiveValues& values,
                                                                       PanelDevice& device);
  virtual ~PanelServer() = default;

  /// Returns the URL to open in a browser, with the key.
  virtual std::string url() const = 0;
  /// Returns why browsers will object to the page's certificate, whoever issued it, and what to do; nullopt
  /// if they will not.
  virtual std::optional<std::string> objection() const = 0;
  /// Pages that look at this moment.
  virtual int pages() const = 0;
  /// To be called some ten times a second: sees who of those that have written is still there.
  virtual void turn(Time now) = 0;
};

}  // namespace coupler::host
