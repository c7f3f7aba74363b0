// Accepts connections with Boost.Beast, asynchronously on one thread, so that a slow or lost connection does
// not delay others. Other threads post their messages to this thread.
#include "app/serve/web_server.h"

#include <fmt/format.h>

#include <optional>

#include "app/serve/web_connection.h"
#include "base/error.h"

namespace sundog {

void WebState::accept_next() {
  acceptor.async_accept([this](NetError error, tcp::socket socket) {
    if (error == asio::error::operation_aborted) return;
    if (error) {  // e.g. no descriptor is left
      pause.expires_after(std::chrono::milliseconds(100));
      pause.async_wait([this](NetError stopped) {
        if (!stopped) accept_next();
      });
      return;
    }
    if (connections < limits.connections) {
      NetError ignored;  // without this option, the connection is only slower
      std::ignore = socket.set_option(tcp::no_delay(true), ignored);
      std::make_shared<WebConnection>(*this, std::move(socket))->read_head();
    }
    accept_next();
  });
}

WebServer::WebServer(int port, const WebLimits& limits) : state_(std::make_unique<WebState>()) {
  state_->limits = limits;
  const tcp::endpoint place(asio::ip::address_v4::loopback(), static_cast<unsigned short>(port));
  NetError error;
  state_->acceptor.open(place.protocol());
  state_->acceptor.set_option(tcp::acceptor::reuse_address(true));
  std::ignore = state_->acceptor.bind(place, error);
  if (!error) std::ignore = state_->acceptor.listen(asio::socket_base::max_listen_connections, error);
  if (error)
    throw IoError(
        fmt::format("serve: --port {}: cannot listen there: {}; without --port, a free one is taken", port,
                    error.message()));
}

WebServer::~WebServer() = default;

int WebServer::port() const { return state_->acceptor.local_endpoint().port(); }

const WebLimits& WebServer::limits() const { return state_->limits; }

namespace {

/// Runs handlers until the server stops. Returns false if an exception escaped a handler (out of memory),
/// which ends only that handler's connection.
bool runs_to_its_end(asio::io_context& io) {
  try {
    io.run();
    return true;
  } catch (const std::exception& error) {
    fmt::print(stderr, "sundog: serve: {}\n", error.what());
    return false;
  }
}

}  // namespace

void WebServer::run(const Gate& gate, WebHandlers handlers) {
  state_->gate = gate;
  state_->handlers = std::move(handlers);
  state_->accept_next();
  while (!runs_to_its_end(state_->io)) {
  }
}

void WebServer::stop() { state_->io.stop(); }

namespace {

/// Makes the server's thread call `use` for each socket, or for one client's. Iterates over a copy of the
/// list, because `use` may remove a socket.
template <class Use>
void post_to(WebState& state, std::optional<ClientId> client, Use use) {
  asio::post(state.io, [&state, client, use = std::move(use)] {
    const auto sockets = state.sockets;
    for (const auto& [id, socket] : sockets)
      if (id == client.value_or(id)) use(*socket);
  });
}

auto sending(std::string text) {
  return [text = std::make_shared<const std::string>(std::move(text))](WebSocket& to) { to.send(text); };
}

auto showing(SharedText picture) {
  return [picture = std::move(picture)](WebSocket& to) { to.show(picture); };
}

}  // namespace

void WebServer::send(ClientId client, std::string text) {
  post_to(*state_, client, sending(std::move(text)));
}

void WebServer::send_to_all(std::string text) { post_to(*state_, {}, sending(std::move(text))); }

void WebServer::show(ClientId client, SharedText picture) {
  post_to(*state_, client, showing(std::move(picture)));
}

void WebServer::show_to_all(SharedText picture) { post_to(*state_, {}, showing(std::move(picture))); }

int WebServer::ready_clients() const { return state_->ready; }

int WebServer::clients() const { return state_->greeted; }

}  // namespace sundog
