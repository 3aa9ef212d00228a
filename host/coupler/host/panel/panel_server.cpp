// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/panel/panel_server.hpp"

#include <httplib.h>

#include <sys/socket.h>

#include <atomic>
#include <charconv>
#include <chrono>
#include <exception>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "coupler/base/what_failed.hpp"
#include "coupler/host/panel/access.hpp"
#include "coupler/host/panel/http_server.hpp"
#include "coupler/host/panel/page.hpp"
#include "coupler/host/panel/page_tls.hpp"
#include "coupler/host/panel/shown_address.hpp"
#include "coupler/host/panel/writers.hpp"
#include "coupler/json/json_text.hpp"

namespace coupler::host {
namespace {

using httplib::Request;
using httplib::Response;

constexpr int most_pages = 8;
/// The number of threads for requests that are not the stream of a page.
constexpr std::size_t more_workers = 16;
constexpr std::chrono::seconds heartbeat{1};
constexpr std::chrono::milliseconds shortest_pause{50};  ///< between two events of a page
constexpr int most_unread = 64 * 1024;
constexpr int backlog = 128;

void answer(Response& response, int status, const std::string& text) {
  response.status = status;
  response.set_content(text + "\n", "text/plain; charset=utf-8");
}

class Server final : public PanelServer {
 public:
  Server(const PanelAddress& address, std::shared_ptr<const PageTls> tls, std::string points,
         LiveValues& values, PanelDevice& device)
      : address_(address),
        tls_(std::move(tls)),
        objection_(tls_ ? tls_->objection(shown_host()) : std::nullopt),
        points_(std::move(points)),
        values_(values),
        device_(device) {
    http_.set_socket_options([](socket_t socket) {
      // SO_REUSEPORT, which httplib sets, is not set here: two panels would share a port and its browsers.
      constexpr int on = 1;
      ::setsockopt(socket, SOL_SOCKET, SO_REUSEADDR, &on, sizeof on);
      // Data that a slow page has not read is old by the time it reads it, so there should be little of it.
      ::setsockopt(socket, SOL_SOCKET, SO_SNDBUF, &most_unread, sizeof most_unread);
    });
    http_.set_payload_max_length(RequestStream::largest_body);
    http_.set_tcp_nodelay(true);
    http_.set_default_headers(
        {{"Content-Security-Policy",
          "default-src 'none'; script-src 'self'; style-src 'self'; connect-src 'self'; "
          "base-uri 'none'; form-action 'none'; frame-ancestors 'none'"},
         {"Referrer-Policy", "no-referrer"},
         {"Cache-Control", "no-store"},
         {"X-Content-Type-Options", "nosniff"},
         {"Cross-Origin-Resource-Policy", "same-origin"}});
    http_.set_pre_routing_handler(
        [this](const Request& request, Response& response) { return judge(request, response); });
    route();
  }
  ~Server() override {
    ending_ = true;
    values_.end();
    http_.stop();
    if (thread_.joinable()) thread_.join();
  }

  tl::expected<void, std::string> listen() {
    port_ = address_.port != 0 ? address_.port : http_.bind_to_any_port(address_.listen);
    const bool is_bound = address_.port != 0 ? http_.bind_to_port(address_.listen, address_.port) : port_ > 0;
    if (!is_bound)
      return tl::unexpected(
          address_.port == 0
              ? fmt::format("cannot listen on {}: is it one of this machine's addresses?", address_.listen)
              : fmt::format("cannot listen on {} port {}: is it in use, or no address of this machine?",
                            address_.listen, address_.port));
    http_.set_backlog(backlog);
    thread_ = std::thread([this] {
      http_.listen_after_bind();
      has_ended_ = true;
    });
    // stop() does nothing before it has begun.
    while (!http_.is_running() && !has_ended_) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    return {};
  }

  std::string url() const override {
    const std::string host = shown_host();
    const bool is_v6 = host.find(':') != std::string::npos;
    return fmt::format("{}://{}{}{}:{}/#{}", tls_ ? "https" : "http", is_v6 ? "[" : "", host,
                       is_v6 ? "]" : "", port_, access_.key());
  }
  std::optional<std::string> objection() const override { return objection_; }
  int pages() const override { return pages_; }

  void turn(Time now) override {
    const std::lock_guard lock(mutex_);
    if (writers_.are_gone(now) && pages_ > 0) device_.writers_left();
  }

 private:
  std::string shown_host() const {
    return address_.name.empty() ? shown_address(address_.listen) : address_.name;
  }

  using Handled = httplib::Server::HandlerResponse;

  /// Before anything else: who asks, and from where.
  Handled judge(const Request& request, Response& response) {
    if (!is_own_page(request.get_header_value("Host"), request.get_header_value("Origin"), request.local_addr,
                     port_, address_.name, tls_ != nullptr)) {
      answer(response, 403,
             "this name or page is not the panel's own; open the address that the terminal shows");
      return Handled::Handled;
    }
    if (tls_ && HttpServer::is_plain()) {  // as browsers do where only the name and the port are typed
      if (request.method == "GET")
        response.set_redirect("https://" + request.get_header_value("Host") + "/");
      else
        answer(response, 400, "this page is served by HTTPS");
      return Handled::Handled;
    }
    if (request.has_header("Transfer-Encoding")) {
      answer(response, 411, "send it as a whole, with its length");
      return Handled::Handled;
    }
    // Four kilobytes may be gigabytes when they are unpacked.
    if (request.has_header("Content-Encoding")) {
      answer(response, 415, "send it as it is");
      return Handled::Handled;
    }
    const bool is_shell = request.path == "/" || request.path == "/panel.js" ||
                          request.path == "/panel.css" || request.path == "/token";
    if (is_shell || page_of(request).number > 0) return Handled::Unhandled;
    answer(response, 401, "open the address that the terminal shows, with what stands behind #");
    return Handled::Handled;
  }

  /// Number 0: nobody.
  Access::Page page_of(const Request& request) {
    return access_.find(request.get_header_value("Authorization")).value_or(Access::Page{});
  }

  void route() {
    const auto file = [this](const char* path, std::string_view text, const char* type) {
      http_.Get(path, [text, type](const Request&, Response& response) {
        response.set_content(text.data(), text.size(), type);
      });
    };
    file("/", panel_page(), "text/html; charset=utf-8");
    file("/panel.js", panel_script(), "text/javascript; charset=utf-8");
    file("/panel.css", panel_style(), "text/css; charset=utf-8");
    http_.Post("/token", [this](const Request& request, Response& response) {
      const std::string token = access_.trade(request.body);
      if (token.empty()) return answer(response, 401, "that is not the key");
      response.set_content(token, "text/plain");
    });
    http_.Get("/points.json", [this](const Request&, Response& response) {
      response.set_content(points_, "application/json");
    });
    http_.Get("/history.json", [this](const Request& request, Response& response) {
      const Time now = std::chrono::steady_clock::now();
      const std::string wanted = request.get_param_value("steps");
      std::size_t steps = History::steps;
      (void)std::from_chars(wanted.data(), wanted.data() + wanted.size(), steps);
      response.set_header("Step", std::to_string(History::number_of(now)));
      response.set_content(values_.histories(now, steps), "application/json");
    });
    http_.Get("/seen.csv", [this](const Request&, Response& response) {
      response.set_content(values_.seen_csv(), "text/csv; charset=utf-8");
    });
    http_.Get("/events", [this](const Request& request, Response& response) { stream(request, response); });
    http_.Post("/write", [this](const Request& request, Response& response) { write(request, response); });
    http_.Post("/alive", [this](const Request& request, Response&) {
      const std::lock_guard lock(mutex_);
      writers_.alive(page_of(request).token, std::chrono::steady_clock::now());
    });
  }

  void write(const Request& request, Response& response) {
    if (!device_.writes()) return answer(response, 403, "this panel only shows; start it with --write");
    const auto asked = nlohmann::json::parse(request.body, nullptr, false);
    const auto text = [&](const char* key) {
      return asked.is_object() && asked.contains(key) && asked[key].is_string();
    };
    if (!text("point") || !text("value"))
      return answer(response, 400, R"(send {"point": "lamp", "value": "true"})");
    // A request may have waited for a worker, and its page may have given it up.
    if (!HttpServer::is_asker_there()) return answer(response, 408, "too late");
    const Access::Page page = page_of(request);
    {
      const std::lock_guard lock(mutex_);
      writers_.wrote(page.token, std::chrono::steady_clock::now());
    }
    const auto outcome = device_.write(page.number, asked["point"], asked["value"]);
    {
      // Once more: it may have been carried out after those before were gone.
      const std::lock_guard lock(mutex_);
      writers_.wrote(page.token, std::chrono::steady_clock::now());
    }
    const nlohmann::ordered_json told{{"outcome", to_string(outcome.outcome)}, {"text", outcome.text}};
    response.set_content(json_text(told), "application/json");
  }

  /// Server-sent events: what is new, and a heartbeat each second. A page that does not read loses what was
  /// between.
  void stream(const Request& request, Response& response) {
    if (const std::string why_not = enter(); !why_not.empty()) return answer(response, 503, why_not);
    auto seen = std::make_shared<std::uint64_t>(0);
    response.set_chunked_content_provider(
        "text/event-stream",
        [this, seen](std::size_t, httplib::DataSink& sink) {
          if (ending_) return false;
          const Time now = std::chrono::steady_clock::now();
          const std::string event =
              "data: " + values_.news(*seen, *seen == 0 ? now : now + shortest_pause, now + heartbeat) +
              "\n\n";
          return sink.is_writable() && sink.write(event.data(), event.size());
        },
        [this, token = page_of(request).token](bool) { leave(token); });
  }

  /// Empty, or why not.
  std::string enter() {
    const std::lock_guard lock(mutex_);
    if (pages_ >= most_pages) return fmt::format("{} pages are open already; close one", most_pages);
    try {
      if (pages_ == 0) device_.look(true);
    } catch (const std::exception& error) {  // no thread is left: another time there may be one
      return what_failed(error);
    }
    ++pages_;
    return {};
  }
  void leave(const std::string& token) {
    const std::lock_guard lock(mutex_);
    writers_.left(token);
    if (--pages_ == 0) device_.look(false);
  }

  const PanelAddress address_;
  const std::shared_ptr<const PageTls> tls_;
  const std::optional<std::string> objection_;  ///< looked for before connections come, which use the same
  const std::string points_;
  LiveValues& values_;
  PanelDevice& device_;
  Access access_;
  std::atomic<bool> ending_{false};
  std::atomic<bool> has_ended_{false};
  std::mutex mutex_;  ///< of who is there
  Writers writers_;
  std::atomic<int> pages_{0};
  int port_ = 0;
  HttpServer http_{most_pages + more_workers, ending_, tls_.get()};
  std::thread thread_;
};

}  // namespace

WriteTicket::Outcome PanelDevice::write(unsigned /*page*/, const std::string& /*point*/,
                                        const std::string& /*value*/) {
  return {WriteResult::Outcome::refused, {}, "refused"};
}

tl::expected<std::unique_ptr<PanelServer>, std::string> PanelServer::start(const PanelAddress& address,
                                                                           std::shared_ptr<const PageTls> tls,
                                                                           std::string points,
                                                                           LiveValues& values,
                                                                           PanelDevice& device) {
  auto server = std::make_unique<Server>(address, std::move(tls), std::move(points), values, device);
  if (auto listens = server->listen(); !listens) return tl::unexpected(std::move(listens).error());
  return server;
}

}  // namespace coupler::host
