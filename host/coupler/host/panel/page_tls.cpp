// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/panel/page_tls.hpp"

#include <sys/socket.h>

#include <optional>
#include <utility>

#include "coupler/credentials/credentials.hpp"
#include "coupler/host/panel/panel_server.hpp"
#include "coupler/tls/stream.hpp"

namespace coupler::host {
namespace {

/// A client that does not speak TLS gets a plain-text error.
class TlsStream final : public RequestStream {
 public:
  TlsStream(socket_t socket, const std::atomic<bool>& ending, const tls::Context& context)
      : RequestStream(socket, ending), stream_(context, socket) {}
  TlsStream(const TlsStream&) = delete;
  TlsStream& operator=(const TlsStream&) = delete;
  ~TlsStream() override {
    if (!is_plain()) stream_.close();
  }

  bool is_plain() const override { return is_plain_.value_or(false); }

 private:
  Progress receive(char* to, std::size_t size) override {
    if (!is_plain_) {
      char first = 0;
      const ssize_t came = ::recv(socket(), &first, 1, MSG_PEEK | MSG_DONTWAIT);
      if (came > 0) is_plain_ = 'A' <= first && first <= 'Z';  // of GET or POST
    }
    return is_plain() ? RequestStream::receive(to, size) : of(stream_.read(to, size));
  }
  Progress give(const char* from, std::size_t size) override {
    return is_plain() ? RequestStream::give(from, size) : of(stream_.write(from, size));
  }
  bool is_there() const override { return RequestStream::is_there() && (is_plain() || stream_.is_there()); }

  static Progress of(tls::Stream::Progress progress) { return {progress.bytes, progress.wants}; }

  mutable tls::Stream stream_;    ///< to look takes what has come from the socket
  std::optional<bool> is_plain_;  ///< once its first byte has come
};

class Files final : public PageTls {
 public:
  explicit Files(tls::Context context) : context_(std::move(context)) {}
  std::unique_ptr<RequestStream> stream(socket_t socket, const std::atomic<bool>& ending) const override {
    return std::make_unique<TlsStream>(socket, ending, context_);
  }
  std::optional<std::string> objection(const std::string& host) const override {
    return context_.objection(host);
  }

 private:
  const tls::Context context_;
};

}  // namespace

tl::expected<std::shared_ptr<const PageTls>, std::string> read_page_tls(const std::string& certificate,
                                                                        const std::string& key) {
  Credentials own;
  auto text = read_pem_file("page's certificate", certificate, "");
  if (!text) return tl::unexpected(std::move(text).error());
  own.certificate = *std::move(text);
  text = read_pem_file("page's key", key, "", true);
  if (!text) return tl::unexpected(std::move(text).error());
  own.key = *std::move(text);
  auto context = tls::Context::for_strangers(own);
  if (!context) return tl::unexpected("the page: " + context.error());
  return std::make_shared<Files>(*std::move(context));
}

}  // namespace coupler::host
