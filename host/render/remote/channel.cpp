// Wire format: message size in 8 bytes, kind and JSON size in 4 bytes each, the JSON, the data.
#include "render/remote/channel.h"
#include "base/json_text.h"

#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <nlohmann/json.hpp>

namespace sundog {
namespace {

template <class T>
void append(std::string& bytes, T value) {
  bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
}

template <class T>
T number_at(const std::string& bytes, std::size_t at) {
  T value{};
  std::memcpy(&value, bytes.data() + at, sizeof value);
  return value;
}

constexpr std::size_t head = 8;
const char* const gone = "the other end of a channel is gone";

}  // namespace

std::string pack(const Message& message) {
  using nlohmann::json;
  const std::string values = json_text(message.values);
  std::string bytes;
  bytes.reserve(head + values.size() + message.data.size());
  append(bytes, static_cast<std::uint32_t>(message.kind));
  append(bytes, static_cast<std::uint32_t>(values.size()));
  return bytes + values + message.data;
}

Message unpack(const std::string& bytes) {
  const std::size_t size = bytes.size() >= head ? number_at<std::uint32_t>(bytes, 4) : 0;
  if (bytes.size() < head + size) throw ChannelClosed("a message is too short");
  Message message;
  message.kind = static_cast<Message::Kind>(number_at<std::uint32_t>(bytes, 0));
  message.values = nlohmann::json::parse(
      bytes.begin() + head, bytes.begin() + static_cast<std::ptrdiff_t>(head + size), nullptr, false);
  if (message.values.is_discarded()) throw ChannelClosed("a message is damaged");
  message.data = bytes.substr(head + size);
  return message;
}

SocketChannel::~SocketChannel() { ::close(socket_); }

void SocketChannel::send(const Message& message) {
  const std::lock_guard lock(sending_);
  const std::string packed = pack(message);
  std::string bytes;
  append(bytes, static_cast<std::uint64_t>(packed.size()));
  bytes += packed;
  for (std::size_t at = 0; at < bytes.size();) {
    const ssize_t sent = ::send(socket_, bytes.data() + at, bytes.size() - at, MSG_NOSIGNAL);
    if (sent < 0 && errno == EINTR) continue;
    if (sent <= 0) throw ChannelClosed(gone);
    at += static_cast<std::size_t>(sent);
  }
}

bool SocketChannel::read_some() {
  std::array<char, 1 << 16> buffer;
  const ssize_t size = ::recv(socket_, buffer.data(), buffer.size(), 0);
  if (size < 0 && errno == EINTR) return true;
  if (size > 0) arrived_.append(buffer.data(), static_cast<std::size_t>(size));
  return size > 0;
}

std::optional<Message> SocketChannel::receive(double seconds) {
  const std::lock_guard lock(receiving_);
  while (true) {
    if (arrived_.size() >= head) {
      const auto size = static_cast<std::size_t>(number_at<std::uint64_t>(arrived_, 0));
      if (arrived_.size() - head >= size) {
        const std::string packed = arrived_.substr(head, size);
        arrived_.erase(0, head + size);
        return unpack(packed);
      }
    }
    pollfd poll{socket_, POLLIN, 0};
    if (::poll(&poll, 1, static_cast<int>(seconds * 1000)) <= 0) return std::nullopt;
    if (!read_some()) throw ChannelClosed(gone);
  }
}

}  // namespace sundog
