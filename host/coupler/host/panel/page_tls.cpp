// SPDX-License-Identifier: Apache-2.0
#include "coupler/host/panel/page_tls.hpp"

#include <utility>

#include "coupler/credentials/credentials.hpp"
#include "coupler/host/panel/panel_server.hpp"
#include "coupler/tls/stream.hpp"

namespace coupler::host {
namespace {

class TlsStream final : public RequestStream {
 public:
  TlsStream(socket_t socket, const std::atomic<bool>& ending, const tls::Context& context)
      : RequestStream(socket, ending), stream_(context, socket) {}

 private:
  bool has_more(Time until) const override { return stream_.has_pending() || RequestStream::has_more(until); }
  ssize_t receive(char* to, std::size_t size, Time until) override {
    return once_it_can([&] { return stream_.read(to, size); }, until);
  }
  ssize_t give(const char* from, std::size_t size, Time until) override {
    return once_it_can([&] { return stream_.write(from, size); }, until);
  }
  bool is_there() const override { return RequestStream::is_there() && stream_.is_there(); }

  template <class Call>
  ssize_t once_it_can(const Call& call, Time until) {
    for (;;) {
      const tls::Stream::Progress done = call();
      if (done.bytes > 0) return done.bytes;
      if (done.wants == 0 || !wait(done.wants, until)) return -1;
    }
  }

  mutable tls::Stream stream_;  ///< to look takes what has come from the socket
};

class Files final : public PageTls {
 public:
  explicit Files(tls::Context context) : context_(std::move(context)) {}
  std::unique_ptr<RequestStream> stream(socket_t socket, const std::atomic<bool>& ending) const override {
    return std::make_unique<TlsStream>(socket, ending, context_);
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
