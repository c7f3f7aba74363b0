// State that a WebServer's connections share. Only web_server.cpp includes this header, web_socket.h and
// web_connection.h, so that only one source includes Boost.
#pragma once
#include <atomic>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket.hpp>
#include <map>
#include <memory>

#include "app/serve/web_server.h"

namespace sundog {
namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = beast::http;
namespace websocket = beast::websocket;
using tcp = asio::ip::tcp;
using NetError = beast::error_code;
using SharedText = std::shared_ptr<const std::string>;

class WebSocket;

struct WebState {
  WebLimits limits;
  // Declared before `io`, whose destruction ends the connections, which update these counts.
  std::size_t connections = 0, upgraded = 0, held_bytes = 0;
  asio::io_context io{1};
  tcp::acceptor acceptor{io};
  asio::steady_timer pause{io};
  Gate gate;
  WebHandlers handlers;
  std::map<ClientId, std::shared_ptr<WebSocket>> sockets;
  ClientId last_id = 0;
  std::atomic<int> ready = 0, greeted = 0;

  void accept_next();
};

/// Adds `by` to the count during its lifetime.
class Counted {
 public:
  explicit Counted(std::size_t& count, std::size_t by = 1) : count_(count), by_(by) { count_ += by_; }
  ~Counted() { count_ -= by_; }
  Counted(const Counted&) = delete;
  Counted& operator=(const Counted&) = delete;

 private:
  std::size_t& count_;
  std::size_t by_;
};

}  // namespace sundog
