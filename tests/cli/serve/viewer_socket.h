// A page's messages to the viewer's server, by a plain socket.
#pragma once
#include <nlohmann/json.hpp>
#include <string>

#include "catch.h"
#include "http_client.h"

/// Sends a message and waits for the answer of that kind.
inline nlohmann::json ask(WebSocketClient& socket, const nlohmann::json& message, const std::string& answer) {
  socket.send(message.dump());
  const auto text = socket.receive_with("\"is\":\"" + answer + "\"");
  REQUIRE(text.has_value());
  return nlohmann::json::parse(*text);
}
