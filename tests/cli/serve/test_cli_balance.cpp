// The viewer's balance of light groups, by plain sockets.
#include <chrono>
#include <thread>

#include "catch.h"
#include "served.h"
#include "viewer_socket.h"

using nlohmann::json;

TEST_CASE("the balance of light groups changes the picture, reaches all pages and is in the command line") {
  json scene = json::parse(viewer_scene);
  scene["render"] = {{"integrator", "path"}, {"samples", 4}};
  scene["image"]["width"] = scene["image"]["height"] = 32;
  scene["lights"] = {{{"type", "point"}, {"position", {3, 4, 3}}, {"group", "key"}}};
  const std::string text = scene.dump();
  const Served own(text.c_str());
  WebSocketClient socket(own.port), other(own.port);
  socket.send(own.token);
  other.send(own.token);
  CHECK(ask(socket, {{"do", "scene"}}, "scene")["resolved"]["light_groups"] == json{"key"});
  const auto picture = [&] {
    HttpReply reply;
    for (int i = 0; i < 600; ++i) {
      reply = http(own.port, http_request(own.port, "GET", "/api/picture?format=png", own.with_token()));
      if (reply.status == 200) break;
      std::this_thread::sleep_for(std::chrono::milliseconds(100));
    }
    REQUIRE(reply.status == 200);
    return reply.body;
  };
  const std::string plain = picture();
  const auto refused = ask(socket, {{"do", "balance"}, {"lights", {"key=much"}}}, "refused")["reason"];
  CHECK(refused.get<std::string>().find("key") != std::string::npos);
  const json lights = {"key=0.25,#ff8000"};
  CHECK(ask(socket, {{"do", "balance"}, {"lights", lights}}, "balance")["lights"] == lights);
  for (json told; told != lights;) {  // the first is that of the greeting
    const auto message = other.receive_with("\"is\":\"balance\"");
    REQUIRE(message.has_value());
    told = json::parse(*message)["lights"];
  }
  CHECK(picture() != plain);
  const std::string command =
      http(own.port, http_request(own.port, "GET", "/api/command", own.with_token())).body;
  CHECK(command.find("-o picture.exr --aov light_groups") != std::string::npos);
  CHECK(command.find(" && sundog mix picture.exr -o picture.png --light 'key=0.25,#ff8000'") !=
        std::string::npos);
  ask(socket, {{"do", "balance"}, {"lights", json::array()}}, "balance");
  CHECK(picture() == plain);
}
