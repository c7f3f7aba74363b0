// A page's WebSocket: its first message is the token, "ack" acknowledges a picture, and all others go to the
// handlers. Sends a picture only after the previous one is acknowledged, and then the newest.
#pragma once
#include <chrono>
#include <deque>

#include "app/serve/web_state.h"

namespace sundog {

class WebSocket : public std::enable_shared_from_this<WebSocket> {
 public:
  WebSocket(WebState& server, tcp::socket&& socket)
      : server_(server), counted_(server.upgraded), stream_(std::move(socket)), patience_(server.io) {}

  void accept(const http::request<http::string_body>& request) {
    auto timeout = websocket::stream_base::timeout::suggested(beast::role_type::server);
    timeout.idle_timeout = std::chrono::seconds(server_.limits.idle_seconds);
    timeout.keep_alive_pings = true;
    stream_.set_option(timeout);
    stream_.read_message_max(256);  // the token
    patience_.expires_after(std::chrono::seconds(server_.limits.hello_seconds));
    patience_.async_wait([self = shared_from_this()](NetError error) {
      if (!error && !self->id_) self->drop();
    });
    stream_.async_accept(request, [self = shared_from_this()](NetError error) {
      if (!error) self->read_next();
    });
  }

  void send(SharedText text) {
    if (gone_) return;
    queued_bytes_ += text->size();
    if (queued_bytes_ > server_.limits.queue_bytes) return drop();
    texts_.push_back(std::move(text));
    write_next();
  }

  void show(SharedText picture) {
    picture_ = std::move(picture);
    write_next();
  }

  void drop() {
    if (gone_) return;
    gone_ = true;
    patience_.cancel();
    beast::get_lowest_layer(stream_).close();
    if (!id_) return;
    server_.sockets.erase(id_);
    --server_.greeted;
    if (!owes_) --server_.ready;
  }

 private:
  void read_next() {
    stream_.async_read(buffer_, [self = shared_from_this()](NetError error, std::size_t) {
      if (error || self->gone_) return self->drop();
      std::string text = beast::buffers_to_string(self->buffer_.data());
      self->buffer_.consume(self->buffer_.size());
      self->take(std::move(text));
    });
  }

  void take(std::string text) {
    if (!id_) {
      if (!equal_in_constant_time(text, server_.gate.token)) return refuse("wrong token");
      greet();
    } else if (!in_rate()) {
      return refuse("too many messages");
    } else if (text == "ack") {
      if (owes_) ++server_.ready;
      owes_ = false;
      write_next();
    } else {
      server_.handlers.message(id_, std::move(text));
    }
    read_next();
  }

  void greet() {
    patience_.cancel();
    id_ = ++server_.last_id;
    stream_.read_message_max(server_.limits.message_bytes);
    server_.sockets.emplace(id_, shared_from_this());
    ++server_.greeted;
    ++server_.ready;
    server_.handlers.opened(id_);
  }

  bool in_rate() {
    const auto now = std::chrono::steady_clock::now();
    if (now - second_ > std::chrono::seconds(1)) second_ = now, messages_ = 0;
    return ++messages_ <= server_.limits.messages_a_second;
  }

  /// Closes with the reason in the close frame, or at once if a write is in progress.
  void refuse(const char* why) {
    if (writing_) return drop();
    writing_ = true;
    stream_.async_close({websocket::close_code::policy_error, why},
                        [self = shared_from_this()](NetError) { self->drop(); });
  }

  void write_next() {
    if (writing_ || gone_ || !id_) return;
    if (!texts_.empty()) {
      now_ = std::move(texts_.front());
      texts_.pop_front();
      queued_bytes_ -= now_->size();
      stream_.text(true);
    } else if (picture_ && !owes_) {
      now_ = std::move(picture_);
      picture_ = nullptr;
      owes_ = true;
      --server_.ready;
      stream_.binary(true);
    } else {
      return;
    }
    writing_ = true;
    stream_.async_write(asio::buffer(*now_), [self = shared_from_this()](NetError error, std::size_t) {
      self->writing_ = false;
      if (error) return self->drop();
      self->write_next();
    });
  }

  WebState& server_;
  Counted counted_;
  websocket::stream<beast::tcp_stream> stream_;
  asio::steady_timer patience_;
  beast::flat_buffer buffer_;
  ClientId id_ = 0;  // 0: the token has not arrived
  std::deque<SharedText> texts_;
  std::size_t queued_bytes_ = 0;
  SharedText picture_, now_;                            // waiting; being written
  bool writing_ = false, owes_ = false, gone_ = false;  // owes_: a picture is not acknowledged
  std::chrono::steady_clock::time_point second_{};
  int messages_ = 0;
};

}  // namespace sundog
