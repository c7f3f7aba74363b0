// A small web server on a loopback address for one page: files and calls over HTTP, messages and pictures
// over WebSockets. The thread that calls run() does all input and output; handlers pass work to other
// threads. Only web_server.cpp includes Boost.
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
  std::string file_name;  // if not empty, the browser saves the body under this name
};

using ClientId = std::uint64_t;

/// The server's thread calls these, so they must not block. Any thread may call `reply`.
struct WebHandlers {
  std::function<void(WebRequest, std::function<void(WebAnswer)> reply)> answer;
  std::function<void(ClientId)> opened;  // a socket has sent the token
  std::function<void(ClientId, std::string)> message;
};

struct WebLimits {
  std::size_t header_bytes = 16 << 10;
  std::size_t body_bytes = 32 << 20, bodies_bytes = 64 << 20;  // one upload, and all uploads in memory
  std::size_t message_bytes = 8 << 20;                         // a message from a socket
  std::size_t connections = 64, sockets = 16;
  int messages_a_second = 400;         // from one socket
  std::size_t queue_bytes = 64 << 20;  // to one socket, which is closed if more is waiting
  int header_seconds = 10, body_seconds = 60, hello_seconds = 10, idle_seconds = 30;
};

struct WebState;  // private to web_server.cpp

class WebServer {
 public:
  /// Listens on 127.0.0.1 at `port` (0: any free port). Throws IoError if the port is taken.
  WebServer(int port, const WebLimits& limits);
  ~WebServer();
  WebServer(const WebServer&) = delete;
  WebServer& operator=(const WebServer&) = delete;

  int port() const;
  const WebLimits& limits() const;
  /// Serves until stop() is called.
  void run(const Gate& gate, WebHandlers handlers);

  // Any thread may call these:
  void stop();
  void send(ClientId client, std::string text);
  void send_to_all(std::string text);
  /// Sends a picture. A client that has not yet acknowledged the previous picture gets this one, or a newer
  /// one, once it has.
  void show_to_all(std::shared_ptr<const std::string> picture);
  void show(ClientId client, std::shared_ptr<const std::string> picture);
  /// The number of sockets that could take a picture now.
  int ready_clients() const;
  int clients() const;

 private:
  std::unique_ptr<WebState> state_;
};

}  // namespace sundog
