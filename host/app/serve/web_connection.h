// An HTTP connection: reads requests, checks each at the gate before reading its body, and sends the answers.
#pragma once
#include <fmt/format.h>

#include <array>
#include <chrono>
#include <optional>

#include "app/serve/web_socket.h"
#include "base/names.h"
#include "base/numbers.h"

namespace sundog {

inline constexpr const char* security_policy =
    "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' blob:; connect-src 'self'; "
    "base-uri 'none'; form-action 'none'; frame-ancestors 'none'";

inline RequestHead head_of(const http::request<http::string_body>& request) {
  RequestHead head;
  head.method = request.method() == http::verb::head ? "GET" : std::string(request.method_string());
  const std::string target(request.target());
  const std::size_t mark = target.find('?');
  head.path = target.substr(0, mark);
  if (mark != std::string::npos) head.query = target.substr(mark + 1);
  for (const auto& field : request) {
    const std::string name = lower_case(std::string(field.name_string()));
    const bool added = head.headers.emplace(name, std::string(field.value())).second;
    if (!added && (name == "host" || name == "origin" || name == token_header)) head.repeated_host = true;
  }
  return head;
}

/// An HTTP connection that handles requests in order, until one of them turns it into a WebSocket.
class WebConnection : public std::enable_shared_from_this<WebConnection> {
 public:
  WebConnection(WebState& server, tcp::socket&& socket)
      : server_(server), counted_(server.connections), stream_(std::move(socket)) {}

  void read_head() {
    parser_.emplace();
    parser_->header_limit(static_cast<std::uint32_t>(server_.limits.header_bytes));
    parser_->body_limit(boost::none);  // check_body() limits it
    stream_.expires_after(std::chrono::seconds(server_.limits.header_seconds));
    http::async_read_header(stream_, buffer_, *parser_,
                            [self = shared_from_this()](NetError error, std::size_t) {
                              if (error == http::error::header_limit)
                                return self->refuse({431, "the head is too large"});
                              if (error == http::error::end_of_stream || error == beast::error::timeout)
                                return;
                              if (error) return self->refuse({400, "this is not HTTP"});
                              self->check_head();
                            });
  }

  /// Answers and closes the connection without reading the rest of the request.
  void refuse(const Refusal& refusal) {
    write({refusal.status, "text/plain; charset=utf-8", refusal.reason + "\n", ""}, false, refusal.allow);
  }

 private:
  void check_head() {
    const auto& request = parser_->get();
    const RequestHead head = head_of(request);
    head_only_ = request.method() == http::verb::head;
    if (const Refusal refusal = check_request(server_.gate, head); refusal.status) return refuse(refusal);
    if (head.path == socket_path) {
      if (server_.upgraded >= server_.limits.sockets) return refuse({503, "too many pages are open"});
      if (!websocket::is_upgrade(request))
        return refuse({426,
                       "wanted a WebSocket; a proxy has to pass the page's on, with its headers Upgrade "
                       "and Connection"});
      stream_.expires_never();
      return std::make_shared<WebSocket>(server_, stream_.release_socket())->accept(parser_->release());
    }
    if (const Refusal refusal = check_body(); refusal.status) return refuse(refusal);
    held_.emplace(server_.held_bytes, parser_->content_length().value_or(0));
    stream_.expires_after(std::chrono::seconds(server_.limits.body_seconds));
    http::async_read(stream_, buffer_, *parser_, [self = shared_from_this()](NetError error, std::size_t) {
      if (!error) self->hand_over();
    });
  }

  /// Refuses a body by its length, before reading it.
  Refusal check_body() const {
    if (parser_->chunked()) return {411, "wanted a Content-Length"};
    const std::uint64_t bytes = parser_->content_length().value_or(0);
    if (bytes > server_.limits.body_bytes)
      return {413, fmt::format("the upload has {} bytes, the viewer takes at most {}: put it into the folder "
                               "that sundog was started in, and open it there",
                               bytes, server_.limits.body_bytes)};
    if (server_.held_bytes + bytes > server_.limits.bodies_bytes)
      return {503, fmt::format("uploads of {} bytes are under way: try again when they are done",
                               server_.held_bytes)};
    return {};
  }

  void hand_over() {
    auto request = parser_->release();
    WebRequest one;
    static_cast<RequestHead&>(one) = head_of(request);
    one.body = std::move(request.body());
    stream_.expires_never();  // the handlers may take their time
    server_.handlers.answer(std::move(one), [self = shared_from_this(),
                                             keep = request.keep_alive()](WebAnswer answer) {
      asio::post(self->server_.io, [self, keep, answer = std::move(answer)] { self->write(answer, keep); });
    });
  }

  void write(const WebAnswer& answer, bool keep, const std::string& allow = "") {
    held_.reset();
    response_ = {static_cast<http::status>(answer.status), 11};
    response_.set(http::field::content_type, answer.type);
    response_.set(http::field::cache_control, "no-store");
    response_.set("Content-Security-Policy", security_policy);
    response_.set("X-Content-Type-Options", "nosniff");
    response_.set("Referrer-Policy", "no-referrer");
    response_.set("Cross-Origin-Resource-Policy", "same-origin");
    response_.set("Cross-Origin-Opener-Policy", "same-origin");
    if (!answer.file_name.empty())
      response_.set(http::field::content_disposition,
                    "attachment; filename*=UTF-8''" + percent_encoded(answer.file_name));
    if (answer.status == 405) response_.set(http::field::allow, allow);
    if (answer.status == 426) response_.set(http::field::upgrade, "websocket");
    response_.keep_alive(keep);
    response_.body() = answer.body;
    response_.prepare_payload();
    if (head_only_) response_.body().clear();  // the head states its length
    stream_.expires_after(std::chrono::seconds(server_.limits.body_seconds));
    http::async_write(stream_, response_, [self = shared_from_this(), keep](NetError error, std::size_t) {
      if (error) return;
      if (keep) return self->read_head();
      NetError ignored;  // the client may have closed first
      std::ignore = self->stream_.socket().shutdown(tcp::socket::shutdown_send, ignored);
      self->drain();
    });
  }

  /// Reads up to 4 MiB more before closing: closing with unread bytes resets the connection, and the client
  /// may lose the answer.
  void drain() {
    stream_.expires_after(std::chrono::seconds(2));
    stream_.async_read_some(asio::buffer(scrap_),
                            [self = shared_from_this()](NetError error, std::size_t bytes) {
                              self->drained_ += bytes;
                              if (!error && self->drained_ <= (std::size_t{4} << 20)) self->drain();
                            });
  }

  WebState& server_;
  Counted counted_;
  std::optional<Counted> held_;  // counts the body's bytes
  beast::tcp_stream stream_;
  beast::flat_buffer buffer_{64 << 10};
  std::optional<http::request_parser<http::string_body>> parser_;
  http::response<http::string_body> response_;
  std::array<char, 4096> scrap_{};
  std::size_t drained_ = 0;
  bool head_only_ = false;
};

}  // namespace sundog
