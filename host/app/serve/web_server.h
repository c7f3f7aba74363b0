// A small web server on a loopback address for one page: files and calls over HTTP, messages and pictures
// over WebSockets. The one thread that run() is called on moves all bytes; the handlers hand their work to
// other threads. Only web_server.cpp reads Boost.
#pragma once
#include <cstdint>
#include <functional>
#include <memory>
#include <string>

#include "app/serve/gate.h"

namespace sundog {

struct WebRequest : RequestHead {
  std::string body;
};

struct WebAnswer {
  int status = 200;
  std::string type = "text/plain; charset=utf-8";
  std::string body;
  std::string file_name;  // not empty: the browser saves it under this name
};

using ClientId = std::uint64_t;

/// Called on the server's thread: none may wait. `reply` and the server's own functions may be called on any
/// thread.
struct WebHandlers {
  std::function<void(WebRequest, std::function<void(WebAnswer)> reply)> answer;
  std::function<void(ClientId)> opened;  // a socket whose first message was the token
  std::function<void(ClientId, std::string)> message;
};

struct WebLimits {
  std::size_t header_bytes = 16 << 10;
  std::size_t body_bytes = 32 << 20, bodies_bytes = 64 << 20;  // of one upload, and of all that are held
  std::size_t message_bytes = 8 << 20;                         // from a socket
  std::size_t connections = 64, sockets = 16;
  int messages_a_second = 400;         // from a socket
  std::size_t queue_bytes = 64 << 20;  // to a socket: one that lags by more is closed
  int header_seconds = 10, body_seconds = 60, hello_seconds = 10, idle_seconds = 30;
};

struct WebState;  // of web_server.cpp alone

class WebServer {
 public:
  /// Listens on 127.0.0.1 at `port` (0: any that is free). Throws IoError when the port is taken.
  WebServer(int port, const WebLimits& limits);
  ~WebServer();
  WebServer(const WebServer&) = delete;
  WebServer& operator=(const WebServer&) = delete;

  int port() const;
  const WebLimits& limits() const;
  /// Serves until stop() is called.
  void run(const Gate& gate, WebHandlers handlers);

  // Any thread:
  void stop();
  void send(ClientId client, std::string text);
  void send_to_all(std::string text);
  /// A client that has not acknowledged the picture before gets this one when it has, or a later one in its
  /// place.
  void show_to_all(std::shared_ptr<const std::string> picture);
  void show(ClientId client, std::shared_ptr<const std::string> picture);
  /// How many sockets could take a picture at once.
  int ready_clients() const;
  int clients() const;

 private:
  std::unique_ptr<WebState> state_;
};

}  // namespace sundog
