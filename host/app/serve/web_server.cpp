// Accepts connections with Boost.Beast, asynchronously on one thread, so that a slow or lost connection
// delays no other; messages from other threads are posted to it.
#include "app/serve/web_server.h"

#include <fmt/format.h>

#include "app/serve/web_connection.h"
#include "base/error.h"

namespace sundog {

void WebState::accept_next() {
  acceptor.async_accept([this](NetError error, tcp::socket socket) {
    if (error == asio::error::operation_aborted) return;
    if (error) {  // as when no descriptor is left
      pause.expires_after(std::chrono::milliseconds(100));
      pause.async_wait([this](NetError stopped) {
        if (!stopped) accept_next();
      });
      return;
    }
    if (connections < limits.connections) {
      NetError ignored;  // a connection without it is slower, no more
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

/// Runs handlers until the server stops. False: an exception escaped a handler (no memory for its bytes); it
/// ends that handler's connection alone.
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

void WebServer::send(ClientId client, std::string text) {
  asio::post(state_->io,
             [state = state_.get(), client, text = std::make_shared<const std::string>(std::move(text))] {
               if (const auto found = state->sockets.find(client); found != state->sockets.end()) {
                 const std::shared_ptr<WebSocket> socket = found->second;  // may take itself off the list
                 socket->send(text);
               }
             });
}

void WebServer::send_to_all(std::string text) {
  asio::post(state_->io, [state = state_.get(), text = std::make_shared<const std::string>(std::move(text))] {
    const auto sockets = state->sockets;
    for (const auto& [id, socket] : sockets) socket->send(text);
  });
}

void WebServer::show_to_all(SharedText picture) {
  asio::post(state_->io, [state = state_.get(), picture = std::move(picture)] {
    const auto sockets = state->sockets;
    for (const auto& [id, socket] : sockets) socket->show(picture);
  });
}

void WebServer::show(ClientId client, SharedText picture) {
  asio::post(state_->io, [state = state_.get(), client, picture = std::move(picture)] {
    if (const auto found = state->sockets.find(client); found != state->sockets.end()) {
      const std::shared_ptr<WebSocket> socket = found->second;
      socket->show(picture);
    }
  });
}

int WebServer::ready_clients() const { return state_->ready; }

int WebServer::clients() const { return state_->greeted; }

}  // namespace sundog
