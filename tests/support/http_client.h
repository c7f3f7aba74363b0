// HTTP and WebSocket over a plain socket. Sends bytes unchanged, so tests can send malformed requests.
#pragma once
#include <optional>
#include <string>

/// A TCP connection to 127.0.0.1; every read ends after `patience` seconds.
class TcpClient {
 public:
  explicit TcpClient(int port, double patience = 10);
  ~TcpClient();
  TcpClient(TcpClient&& other) noexcept : socket_(other.socket_) { other.socket_ = -1; }
  TcpClient(const TcpClient&) = delete;
  TcpClient& operator=(const TcpClient&) = delete;

  /// False if the other side has closed.
  bool send(const std::string& bytes) const;
  /// Exactly `size` bytes; nothing if the other side has closed or time is up.
  std::optional<std::string> read(std::size_t size) const;
  /// Bytes up to and including `end`.
  std::optional<std::string> read_until(const std::string& end) const;
  /// A connection with a small receive window, so that a server that writes much must soon wait.
  static TcpClient with_small_window(int port);

 private:
  int socket_ = -1;
};

struct HttpReply {
  int status = 0;  // 0: no reply
  std::string head, body;
};

/// Sends these bytes and reads one reply.
HttpReply http(int port, const std::string& request);
/// Sends the request over an open connection.
HttpReply http(const TcpClient& client, const std::string& request);

/// A well-formed request; `more` are whole header lines, each with "\r\n".
std::string http_request(int port, const std::string& method, const std::string& path,
                         const std::string& more = "", const std::string& body = "");

/// A WebSocket's client.
class WebSocketClient {
 public:
  /// Performs the handshake. An empty `origin` is not sent. status() is 101 on success.
  WebSocketClient(int port, const std::string& origin = "", bool small_window = false);
  int status() const { return status_; }
  void send(const std::string& text) const;
  /// The next message's payload; nothing if the socket is closed. Answers pings.
  std::optional<std::string> receive();
  /// The next text message that contains `part`. Acknowledges pictures.
  std::optional<std::string> receive_with(const std::string& part);
  bool last_was_binary() const { return binary_; }
  int close_code() const { return close_code_; }

 private:
  TcpClient client_;
  int status_ = 0, close_code_ = 0;
  bool binary_ = false;
};
