// Sends raw HTTP and WebSocket bytes, and parses the answers.
#include "http_client.h"

#include <arpa/inet.h>
#include <sys/socket.h>
#include <sys/time.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <cstdint>
#include <cstdlib>
#include <stdexcept>

namespace {

constexpr std::size_t most_bytes = std::size_t{64} << 20;

int connect_to(int port, double patience, int window) {
  const int socket = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
  if (window > 0) ::setsockopt(socket, SOL_SOCKET, SO_RCVBUF, &window, sizeof window);
  const timeval limit{static_cast<time_t>(patience),
                      static_cast<suseconds_t>(1e6 * (patience - static_cast<int>(patience)))};
  ::setsockopt(socket, SOL_SOCKET, SO_RCVTIMEO, &limit, sizeof limit);
  ::setsockopt(socket, SOL_SOCKET, SO_SNDTIMEO, &limit, sizeof limit);
  sockaddr_in place{};
  place.sin_family = AF_INET;
  place.sin_port = htons(static_cast<std::uint16_t>(port));
  place.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  if (::connect(socket, reinterpret_cast<const sockaddr*>(&place), sizeof place) == 0) return socket;
  ::close(socket);
  throw std::runtime_error("no server at port " + std::to_string(port));
}

int status_of(const std::string& head) {
  return head.starts_with("HTTP/1.1 ") ? std::atoi(head.c_str() + 9) : 0;
}

std::size_t length_of(std::string head) {
  std::ranges::transform(head, head.begin(),
                         [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  const std::size_t at = head.find("content-length:");
  return at == std::string::npos ? 0 : static_cast<std::size_t>(std::atoll(head.c_str() + at + 15));
}

}  // namespace

TcpClient::TcpClient(int port, double patience) : socket_(connect_to(port, patience, 0)) {}

TcpClient TcpClient::with_small_window(int port) {
  TcpClient client(port);
  ::close(client.socket_);
  client.socket_ = connect_to(port, 10, 2048);
  return client;
}

TcpClient::~TcpClient() {
  if (socket_ >= 0) ::close(socket_);
}

bool TcpClient::send(const std::string& bytes) const {
  for (std::size_t sent = 0; sent < bytes.size();) {
    const ssize_t size = ::send(socket_, bytes.data() + sent, bytes.size() - sent, MSG_NOSIGNAL);
    if (size <= 0) return false;
    sent += static_cast<std::size_t>(size);
  }
  return true;
}

std::optional<std::string> TcpClient::read(std::size_t size) const {
  if (size > most_bytes) return {};
  std::string bytes(size, '\0');
  for (std::size_t got = 0; got < size;) {
    const ssize_t some = ::recv(socket_, bytes.data() + got, size - got, 0);
    if (some <= 0) return {};
    got += static_cast<std::size_t>(some);
  }
  return bytes;
}

std::optional<std::string> TcpClient::read_until(const std::string& end) const {
  std::string bytes;
  while (!bytes.ends_with(end)) {
    const auto one = read(1);
    if (!one || bytes.size() > 1 << 20) return {};
    bytes += *one;
  }
  return bytes;
}

HttpReply http(const TcpClient& client, const std::string& request) {
  HttpReply reply;
  client.send(request);  // may fail: a server that refuses early closes early, but has answered
  const auto head = client.read_until("\r\n\r\n");
  if (!head) return reply;
  reply.head = *head;
  reply.status = status_of(*head);
  reply.body = client.read(length_of(*head)).value_or("");
  return reply;
}

HttpReply http(int port, const std::string& request) { return http(TcpClient(port), request); }

std::string http_request(int port, const std::string& method, const std::string& path,
                         const std::string& more, const std::string& body) {
  const std::string length =
      method == "POST" ? "Content-Length: " + std::to_string(body.size()) + "\r\n" : "";
  return method + " " + path + " HTTP/1.1\r\nHost: 127.0.0.1:" + std::to_string(port) + "\r\n" + more +
         length + "\r\n" + body;
}

WebSocketClient::WebSocketClient(int port, const std::string& origin, bool small_window)
    : client_(small_window ? TcpClient::with_small_window(port) : TcpClient(port)) {
  const std::string from = origin.empty() ? "" : "Origin: " + origin + "\r\n";
  client_.send(http_request(port, "GET", "/ws",
                            "Upgrade: websocket\r\nConnection: Upgrade\r\nSec-WebSocket-Version: 13\r\n"
                            "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n" +
                                from));
  status_ = status_of(client_.read_until("\r\n\r\n").value_or(""));
}

void WebSocketClient::send(const std::string& text) const {
  std::string frame = "\x81";
  if (text.size() < 126) {
    frame += static_cast<char>(0x80 | text.size());
  } else if (text.size() < 65536) {
    frame += static_cast<char>(0x80 | 126);
    frame += static_cast<char>(text.size() >> 8);
    frame += static_cast<char>(text.size() & 255);
  } else {
    frame += static_cast<char>(0x80 | 127);
    for (int shift = 56; shift >= 0; shift -= 8) frame += static_cast<char>(text.size() >> shift & 255);
  }
  frame += std::string(4, '\0');  // a mask that changes nothing
  client_.send(frame + text);
}

std::optional<std::string> WebSocketClient::receive() {
  for (;;) {
    const auto head = client_.read(2);
    if (!head) return {};
    const int kind = (*head)[0] & 15;
    std::size_t size = static_cast<unsigned char>((*head)[1]) & 127;
    if (size >= 126) {
      const auto more = client_.read(size == 126 ? 2 : 8);
      if (!more) return {};
      size = 0;
      for (const char c : *more) size = size << 8 | static_cast<unsigned char>(c);
    }
    const auto payload = client_.read(size);
    if (!payload) return {};
    if (kind == 8) {
      if (payload->size() >= 2)
        close_code_ =
            static_cast<unsigned char>((*payload)[0]) << 8 | static_cast<unsigned char>((*payload)[1]);
      return {};
    }
    if (kind == 9) {
      client_.send(std::string("\x8a\x80", 2) + std::string(4, '\0'));
      continue;
    }
    binary_ = kind == 2;
    return payload;
  }
}

std::optional<std::string> WebSocketClient::receive_with(const std::string& part) {
  for (int messages = 0; messages < 2000; ++messages) {
    const auto message = receive();
    if (!message) return {};
    if (binary_) {
      send("ack");
    } else if (message->find(part) != std::string::npos) {
      return message;
    }
  }
  return {};
}
