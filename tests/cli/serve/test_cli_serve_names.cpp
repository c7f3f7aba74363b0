// The viewer's server by the names and methods of other programs than its page: proxies, scripts, curl.
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "base/file.h"
#include "catch.h"
#include "http_client.h"
#include "run_command.h"
#include "served.h"
#include "viewer_socket.h"

using nlohmann::json;

namespace {

Served& served() {
  static Served one;
  return one;
}

HttpReply ask_for(const std::string& method, const std::string& path, const std::string& more = "") {
  return http(served().port, http_request(served().port, method, path, more));
}

std::string header(const HttpReply& reply, const std::string& name) {
  const std::size_t at = reply.head.find("\r\n" + name + ": ");
  if (at == std::string::npos) return "";
  const std::size_t from = at + name.size() + 4;
  return reply.head.substr(from, reply.head.find("\r\n", from) - from);
}

std::string command_line(const Served& viewer) {
  return http(viewer.port, http_request(viewer.port, "GET", "/api/command", viewer.with_token())).body;
}

std::string upload(const Served& viewer, const std::string& name, const std::string& bytes) {
  const HttpReply reply = http(
      viewer.port, http_request(viewer.port, "POST", "/api/scene?name=" + name, viewer.with_token(), bytes));
  INFO(reply.body);
  REQUIRE(reply.status == 200);
  return command_line(viewer);
}

}  // namespace

TEST_CASE("--host admits a name at its port, at a scheme's default port without it, and no other") {
  const TemporaryFolder folder;
  folder.write("scene.json", viewer_scene);
  BackgroundProgram program({SUNDOG_BINARY, "serve", "scene.json", "--host", "Safe.example:443", "--host",
                             "plain.example:80", "--host", "both.example", "--host", "[fd00::1]"},
                            folder.path());
  const std::string url = program.line_with("http://");
  const int port = std::stoi(url.substr(url.find(':', 7) + 1));
  const auto status = [&](const std::string& host, const std::string& origin) {
    const std::string from = origin.empty() ? "" : "Origin: " + origin + "\r\n";
    return http(port, "GET / HTTP/1.1\r\nHost: " + host + "\r\n" + from + "\r\n").status;
  };
  struct Row {
    const char *host, *origin;
    int status;
  };
  for (const Row& row :
       {Row{"safe.example", "https://safe.example", 200},
        Row{"safe.example:443", "https://safe.example", 200}, Row{"SAFE.example", "", 200},
        Row{"safe.example", "http://safe.example", 403},  // is at port 80
        Row{"safe.example", "https://evil.example", 403}, Row{"safe.example:80", "", 421},
        Row{"plain.example", "http://plain.example", 200}, Row{"plain.example", "https://plain.example", 403},
        Row{"both.example", "http://both.example", 200}, Row{"both.example", "https://both.example", 200},
        Row{"both.example:8443", "https://both.example:8443", 421},
        Row{"[fd00::1]", "https://[fd00::1]", 200}, Row{"evil.example", "https://evil.example", 421},
        Row{"safe.example.evil.example", "", 421}}) {
    INFO(row.host << " " << row.origin);
    CHECK(status(row.host, row.origin) == row.status);
  }
}

TEST_CASE("HEAD has the head of GET, and no body") {
  for (const std::string path : {"/", "/link.js", "/api/scene", "/none"}) {
    INFO(path);
    const TcpClient client(served().port);  // one connection: a body would be read as the next answer
    const std::string one = http_request(served().port, "HEAD", path, served().with_token());
    client.send(one + one);
    const auto first = client.read_until("\r\n\r\n"), second = client.read_until("\r\n\r\n");
    REQUIRE((first && second));
    CHECK(*first == ask_for("GET", path, served().with_token()).head);
    CHECK(*second == *first);
  }
  CHECK(ask_for("HEAD", "/api/scene").status == 401);
}

TEST_CASE("a method that is not taken is answered with those that are") {
  const HttpReply page = ask_for("PUT", "/"), call = ask_for("DELETE", "/api/scene", served().with_token());
  CHECK(page.status == 405);
  CHECK(header(page, "Allow") == "GET, HEAD");
  CHECK(call.status == 405);
  CHECK(header(call, "Allow") == "GET, HEAD, POST");
}

TEST_CASE("a page learns by a request why its socket is refused") {
  const std::string own = "Origin: http://127.0.0.1:" + std::to_string(served().port) + "\r\n";
  const HttpReply swallowed = ask_for("POST", "/ws", own);
  CHECK(swallowed.status == 426);
  CHECK(header(swallowed, "Upgrade") == "websocket");
  CHECK(swallowed.body.find("a proxy has to pass") != std::string::npos);
  const HttpReply foreign = ask_for("POST", "/ws", "Origin: https://my.example\r\n");
  CHECK(foreign.status == 403);
  CHECK(foreign.body.find("--host NAME") != std::string::npos);
  std::vector<std::unique_ptr<WebSocketClient>> pages;
  for (int i = 0; i < 16; ++i) pages.push_back(std::make_unique<WebSocketClient>(served().port));
  CHECK(ask_for("POST", "/ws", own).body == "too many pages are open\n");
}

TEST_CASE("serve ends where nobody can read its address") {
  CommandOptions patience;
  patience.timeout = 60;
  const CommandResult result =
      run_command({"sh", "-c", "exec \"$0\" serve > /dev/full", SUNDOG_BINARY}, patience);
  CHECK_FALSE(result.timed_out);
  CHECK(result.status == 1);
  CHECK(result.err.find("the standard output cannot be written") != std::string::npos);
}

TEST_CASE(
    "the command line names a dropped model as the saved scene does, and other scenes by what holds them") {
  const Served viewer;
  const std::string model = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", opened = command_line(viewer);
  CHECK(opened.starts_with("sundog render " + viewer.scene + " -o picture.png"));
  CHECK(upload(viewer, "a1.obj", "mtllib none.mtl\n" + model)
            .starts_with("sundog render a1.obj -o picture.png"));
  const HttpReply saved =
      http(viewer.port, http_request(viewer.port, "GET", "/api/scene", viewer.with_token()));
  CHECK(json::parse(saved.body)["objects"][0]["file"] == "a1.obj");
  WebSocketClient socket(viewer.port);
  socket.send(viewer.token);
  const auto scene = socket.receive_with("\"is\":\"scene\"");
  REQUIRE(scene.has_value());
  CHECK(json::parse(*scene)["resolved"]["warnings"][0] ==
        "a1.obj: line 1: the material library none.mtl is missing");
  // A dropped scene is not the file of that name in the folder.
  CHECK(upload(viewer, "other.json", viewer_scene).starts_with("sundog render other.json -o picture.png"));
  viewer.folder.write("it's here.json", viewer_scene);
  socket.send(R"({"do": "open", "file": "it's here.json"})");
  REQUIRE(socket.receive_with("\"file\":\"it's here.json\"").has_value());
  CHECK(command_line(viewer).starts_with("sundog render '" + viewer.folder.path().string() +
                                         "/it'\\''s here.json' -o picture.png"));
}

TEST_CASE("a saved scene's name reaches the browser as it is") {
  const Served viewer;
  viewer.folder.write("a \"new\" one.json", viewer_scene);
  WebSocketClient socket(viewer.port);
  socket.send(viewer.token);
  REQUIRE(socket.receive_with("\"is\":\"scene\"").has_value());
  CHECK(ask(socket, {{"do", "open"}, {"file", "a \"new\" one.json"}}, "scene")["file"] ==
        "a \"new\" one.json");
  const HttpReply saved =
      http(viewer.port, http_request(viewer.port, "GET", "/api/scene", viewer.with_token()));
  CHECK(header(saved, "Content-Disposition") == "attachment; filename*=UTF-8''a%20%22new%22%20one.json");
}
