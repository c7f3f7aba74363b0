// The viewer's server against requests that no page of its own makes: by plain sockets.
#include <chrono>
#include <fstream>
#include <nlohmann/json.hpp>
#include <thread>

#include "base/file.h"
#include "catch.h"
#include "http_client.h"
#include "run_command.h"
#include "served.h"
#include "viewer_socket.h"

using nlohmann::json;

namespace {

/// One server for all cases: each asks it something else.
Served& served() {
  static Served one;
  return one;
}

HttpReply get(const std::string& path, const std::string& more = "") {
  return http(served().port, http_request(served().port, "GET", path, more));
}

HttpReply post(const std::string& path, const std::string& body) {
  return http(served().port, http_request(served().port, "POST", path, served().with_token(), body));
}

/// A socket that has said its token.
WebSocketClient greeted() {
  WebSocketClient socket(served().port);
  socket.send(served().token);
  return socket;
}

}  // namespace

TEST_CASE("serve prints a loopback address with a token in its fragment") {
  CHECK(served().url.starts_with("http://127.0.0.1:"));
  CHECK(served().token.size() == 32);
  CHECK(served().token.find_first_not_of("0123456789abcdef") == std::string::npos);
  const Served another;
  CHECK(another.token != served().token);
}

TEST_CASE("the page comes without a token, and with a policy that lets it load from here alone") {
  const HttpReply page = get("/");
  CHECK(page.status == 200);
  CHECK(page.head.find("Content-Security-Policy: default-src 'none'; script-src 'self';") !=
        std::string::npos);
  CHECK(page.head.find("frame-ancestors 'none'") != std::string::npos);
  CHECK(page.body.find("http://") == std::string::npos);
  CHECK(get("/vendor/hooks.module.js").body.find("\"preact\"") == std::string::npos);
  CHECK(get("/surfaces.jpg").status == 200);
}

TEST_CASE("calls want the token in their header, not in the address") {
  for (const char* call : {"/api/scene", "/api/schema", "/api/formulas", "/api/files", "/api/command",
                           "/api/picture?format=png"}) {
    INFO(call);
    CHECK(get(call).status == 401);
    CHECK(get(call, "X-Sundog-Token: 0123456789abcdef0123456789abcdef\r\n").status == 401);
    CHECK(get(std::string(call) + (std::string(call).find('?') == std::string::npos ? "?" : "&") +
              "token=" + served().token)
              .status == 401);
    CHECK(get(call, "Cookie: token=" + served().token + "\r\n").status == 401);
  }
  CHECK(get("/api/scene", served().with_token()).status == 200);
}

TEST_CASE("another Host is refused, with the token too: DNS rebinding") {
  const std::string port = std::to_string(served().port);
  for (const std::string& host :
       std::vector<std::string>{"evil.example", "evil.example:" + port, "127.0.0.1", "127.0.0.1:1",
                                "127.0.0.1:" + port + ".evil.example"}) {
    INFO(host);
    const std::string same = "Host: " + host + "\r\nOrigin: http://" + host + "\r\n" + served().with_token();
    CHECK(http(served().port, "GET /api/scene HTTP/1.1\r\n" + same + "\r\n").status == 421);
    CHECK(http(served().port, "GET / HTTP/1.1\r\nHost: " + host + "\r\n\r\n").status == 421);
  }
  CHECK(http(served().port, "GET / HTTP/1.1\r\n\r\n").status == 421);
  CHECK(get("/", "Host: evil.example\r\n").status == 421);  // a second one
  CHECK(http(served().port, "GET / HTTP/1.1\r\nHost: localhost:" + port + "\r\n\r\n").status == 200);
}

TEST_CASE("another Origin is refused") {
  for (const char* origin : {"http://evil.example", "null", "https://127.0.0.1", "http://127.0.0.1:1"}) {
    INFO(origin);
    CHECK(get("/api/scene", served().with_token() + "Origin: " + origin + "\r\n").status == 403);
    CHECK(WebSocketClient(served().port, origin).status() == 403);
  }
  CHECK(WebSocketClient(served().port, "http://127.0.0.1:" + std::to_string(served().port)).status() == 101);
}

TEST_CASE("a GET changes nothing, and other methods are not taken") {
  CHECK(get("/api/scene?do=undo", served().with_token()).status == 200);
  for (const char* method : {"PUT", "DELETE", "OPTIONS", "PATCH"})
    CHECK(http(served().port, http_request(served().port, method, "/api/scene", served().with_token()))
              .status == 405);
  CHECK(http(served().port, http_request(served().port, "POST", "/", served().with_token(), "{}")).status ==
        405);
}

TEST_CASE("a socket's first message is the token; without it nothing is said") {
  WebSocketClient wrong(served().port);
  REQUIRE(wrong.status() == 101);
  wrong.send("0123456789abcdef0123456789abcdef");
  CHECK(!wrong.receive().has_value());
  CHECK(wrong.close_code() == 1008);
  WebSocketClient large(served().port);
  large.send(std::string(5000, 'x'));  // more than a token
  CHECK(!large.receive().has_value());
  CHECK(greeted().receive_with("\"is\":\"scene\"").has_value());
}

TEST_CASE("paths lead to the page's files alone") {
  for (const char* path :
       {"/../scene.json", "/..%2fscene.json", "/%2e%2e/scene.json", "/etc/passwd", "//etc/passwd",
        "/scene.json", "/scene.schema.json", "/vendor/../../scene.json", "scene.schema.json"}) {
    INFO(path);
    CHECK(get(path).status != 200);
  }
}

TEST_CASE("scenes are opened below the folder alone") {
  const auto outside = TemporaryFolder();
  const std::string secret = outside.write("secret.json", viewer_scene).string();
  std::filesystem::create_symlink(secret, served().folder / "link.json");
  WebSocketClient socket = greeted();
  for (const std::string& file :
       {std::string("../secret.json"), secret, std::string("/etc/passwd"), std::string("sub/../../x.json"),
        std::string("link.json"), std::string("missing.json"), std::string("sub"), std::string("")}) {
    INFO(file);
    const json answer = ask(socket, {{"do", "open"}, {"file", file}}, "refused");
    CHECK(answer["reason"].get<std::string>().find("below the folder") != std::string::npos);
  }
  std::ofstream(served().folder / "broken.json") << R"({"objects": [{"type": "sphere", "radus": 1}]})";
  const json refused = ask(socket, {{"do", "open"}, {"file", "broken.json"}}, "refused");
  CHECK(refused["at"] == "");  // not a place in the scene that the page shows
  CHECK(refused["reason"].get<std::string>().find("broken.json: /objects/0") != std::string::npos);
  const json listed = json::parse(get("/api/files", served().with_token()).body);
  CHECK(std::ranges::count(listed, json("sub/other.json")) == 1);
  CHECK(ask(socket, {{"do", "open"}, {"file", "sub/other.json"}}, "scene")["file"] == "other.json");
  CHECK(ask(socket, {{"do", "open"}, {"file", "scene.json"}}, "scene")["file"] == "scene.json");
}

TEST_CASE("a page's scene may neither carry native code nor name files outside its folder") {
  const json native = {{"type", "native"}, {"code", "return length(p) - 1;"}, {"material", "red"}};
  WebSocketClient socket = greeted();
  const auto refusal = [&](const json& object) {
    const json change = {{"at", "/objects/-"}, {"value", object}};
    return ask(socket, {{"do", "edit"}, {"id", 1}, {"changes", {change}}}, "refused")["reason"]
        .get<std::string>();
  };
  CHECK(refusal(native).find("native") != std::string::npos);
  CHECK(refusal({{"type", "model"}, {"file", "../../etc/passwd.obj"}}).find("folder") != std::string::npos);
  CHECK(refusal({{"type", "model"}, {"file", "/etc/passwd"}}).find("folder") != std::string::npos);
  json scene = json::parse(viewer_scene);
  scene["objects"].push_back(native);
  const HttpReply upload = post("/api/scene?name=x.json", scene.dump());
  CHECK(upload.status == 422);
  CHECK(upload.body.find("native") != std::string::npos);
  CHECK(json::parse(get("/api/scene", served().with_token()).body)["objects"].size() == 2);
}

TEST_CASE("the folder of what was dropped on the page goes when a signal ends the server") {
  const TemporaryFolder folder, temporary;
  folder.write("scene.json", viewer_scene);
  BackgroundProgram program({SUNDOG_BINARY, "serve", "scene.json"}, folder.path(),
                            {{"TMPDIR", temporary.path().string()}});
  const std::string url = program.line_with("http://");
  const int port = std::stoi(url.substr(url.find(':', 7) + 1));
  const std::string token = "X-Sundog-Token: " + url.substr(url.find("token=") + 6) + "\r\n";
  const auto uploads = [&] {
    int count = 0;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(temporary.path()))
      count += entry.path().filename() == "dropped.obj";
    return count;
  };
  const HttpReply dropped = http(port, http_request(port, "POST", "/api/scene?name=dropped.obj", token,
                                                    "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"));
  CHECK(dropped.status == 200);
  CHECK(uploads() == 1);
  program.end();  // SIGTERM
  CHECK(uploads() == 0);
  CHECK(temporary.entries() == 0);
}

TEST_CASE("bodies, heads and messages are bounded") {
  const std::string huge = "Content-Length: 900000000\r\n";
  CHECK(http(served().port, "POST /api/scene HTTP/1.1\r\nHost: 127.0.0.1:" + std::to_string(served().port) +
                                "\r\n" + served().with_token() + huge + "\r\n")
            .status == 413);
  CHECK(get("/", "X-Long: " + std::string(100'000, 'a') + "\r\n").status == 431);
  CHECK(http(served().port, "not http at all\r\n\r\n").status == 400);
  WebSocketClient socket = greeted();
  REQUIRE(socket.receive_with("\"is\":\"scene\"").has_value());
  socket.send("{\"do\":\"" + std::string(9'000'000, 'x') + "\"}");
  CHECK(!socket.receive_with("never said").has_value());
  CHECK(get("/").status == 200);
}

TEST_CASE("an upload is refused by its length, with the figure, before it is held") {
  const std::string head =
      "POST /api/scene?name=a.glb HTTP/1.1\r\nHost: 127.0.0.1:" + std::to_string(served().port) + "\r\n" +
      served().with_token();
  const HttpReply large = http(served().port, head + "Content-Length: 33554433\r\n\r\n");
  CHECK(large.status == 413);
  CHECK(large.body.find("33554433 bytes") != std::string::npos);
  CHECK(large.body.find("33554432") != std::string::npos);
  CHECK(http(served().port, head + "Transfer-Encoding: chunked\r\n\r\n0\r\n\r\n").status == 411);
  // Two that are under way take what there is for all.
  const TcpClient first(served().port), second(served().port);
  for (const TcpClient* one : {&first, &second}) one->send(head + "Content-Length: 33000000\r\n\r\nsome");
  HttpReply third;
  for (int tries = 0; tries < 100 && third.status != 503; ++tries)
    third = http(served().port, head + "Content-Length: 3000000\r\n\r\n" + std::string(3'000'000, 'x'));
  CHECK(third.status == 503);
  CHECK(get("/").status == 200);
}

TEST_CASE("a scene larger than the viewer holds is refused by its length") {
  const std::string large = "{\"name\": \"" + std::string(17'000'000, 'x') + "\"}";
  const HttpReply upload = post("/api/scene?name=large.json", large);
  CHECK(upload.status == 422);
  CHECK(upload.body.find("at most 16777216 bytes of JSON, found 17000012") != std::string::npos);
  served().folder.write("large.json", large);
  WebSocketClient socket = greeted();
  CHECK(ask(socket, {{"do", "open"}, {"file", "large.json"}}, "refused")["reason"].get<std::string>().find(
            "found 17000012") != std::string::npos);
  std::filesystem::remove(served().folder / "large.json");
  CHECK(ask(socket, {{"do", "scene"}}, "scene")["file"] == "scene.json");
}

TEST_CASE("a frame that pages cannot show or the machine cannot hold is refused, and the server goes on") {
  const TemporaryFolder folder;
  folder.write("scene.json", viewer_scene);
  // 12 GB of addresses, on a machine of any size.
  BackgroundProgram program({"sh", "-c", "ulimit -v 12000000; exec \"$0\" serve scene.json", SUNDOG_BINARY},
                            folder.path());
  const std::string url = program.line_with("http://");
  const int port = std::stoi(url.substr(url.find(':', 7) + 1));
  WebSocketClient socket(port);
  socket.send(url.substr(url.find("token=") + 6));
  const auto resize = [&](int width, int height, const std::string& answer) {
    const json changes = {{{"at", "/image/width"}, {"value", width}},
                          {{"at", "/image/height"}, {"value", height}}};
    return ask(socket, {{"do", "edit"}, {"id", 1}, {"changes", changes}}, answer);
  };
  const json wide = resize(65536, 1, "refused"), high = resize(1, 65501, "refused");
  CHECK(wide["at"] == "/image/width");
  CHECK(high["at"] == "/image/height");
  CHECK(wide["reason"].get<std::string>().find("at most 65500 pixels an edge, found 65536") !=
        std::string::npos);
  const json large = resize(12000, 12000, "refused");
  CHECK(large["reason"].get<std::string>().find("12000x12000 pixels take 18.7 GB") != std::string::npos);
  resize(65500, 1, "changed");
  REQUIRE(socket.receive_with("\"settled\":true").has_value());
  resize(96, 96, "changed");
  REQUIRE(socket.receive_with("\"settled\":true").has_value());
}

TEST_CASE("messages that come too fast close their socket, and no other") {
  WebSocketClient other = greeted(), fast = greeted();
  for (int i = 0; i < 2000; ++i) fast.send("{}");
  CHECK(!fast.receive_with("never said").has_value());
  CHECK(!fast.receive().has_value());
  // The reason comes along unless a message was being written.
  CHECK((fast.close_code() == 1008 || fast.close_code() == 0));
  CHECK(ask(other, {{"do", "scene"}}, "scene")["file"] == "scene.json");
}

TEST_CASE("odd messages are refused in words") {
  WebSocketClient socket = greeted();
  for (const char* text :
       {"{", "[]", "7", "{\"do\":5}", "{\"do\":\"format the disk\"}", "{\"do\":\"edit\"}",
        "{\"do\":\"edit\",\"changes\":[{}]}",
        "{\"do\":\"edit\",\"changes\":[{\"at\":\"camera\",\"value\":1}]}",
        "{\"do\":\"edit\",\"changes\":[{\"at\":\"/objects/99999999\",\"value\":1}]}",
        "{\"do\":\"edit\",\"changes\":[{\"at\":\"/camera/fov\",\"value\":1e999}]}", "{\"do\":\"pick\"}",
        "{\"do\":\"pick\",\"x\":1e300,\"y\":4}", "{\"do\":\"pick\",\"x\":-3e9,\"y\":4}",
        "{\"do\":\"pick\",\"x\":\"4\",\"y\":4}", "{\"do\":\"devices\",\"specs\":[\"no such\"]}",
        "{\"do\":\"options\",\"split\":\"1,2,3,4,5,6,7\"}"}) {
    INFO(text);
    socket.send(text);
    const auto answer = socket.receive_with("\"is\":\"refused\"");
    REQUIRE(answer.has_value());
    CHECK(json::parse(*answer)["reason"].get<std::string>().size() > 5);
  }
}

TEST_CASE("a client that stops reading, and one that never sends, hold up nobody") {
  WebSocketClient asleep(served().port, "", true);
  asleep.send(served().token);
  const TcpClient silent(served().port);
  const TcpClient slow(served().port);
  slow.send("GET / HTTP/1.1\r\nHost: ");
  WebSocketClient awake = greeted();
  for (int i = 0; i < 200; ++i) ask(awake, {{"do", "scene"}}, "scene");
  for (int i = 0; i < 5; ++i) {
    const json change = {{"at", "/camera/fov"}, {"value", 40 + i}};
    CHECK(ask(awake, {{"do", "edit"}, {"id", i}, {"changes", {change}}}, "changed")["id"] == i);
  }
  CHECK(get("/").status == 200);
}

TEST_CASE("a token file is made for its owner alone, and must hold a token") {
  const TemporaryFolder folder;
  folder.write("scene.json", viewer_scene);
  const auto refused = [&](const std::string& file) {
    const CommandResult result =
        run_sundog({"serve", (folder / "scene.json").string(), "--token-file", (folder / file).string()});
    CHECK(result.status == 2);
    CHECK(result.err.find("--token-file") != std::string::npos);
  };
  {
    BackgroundProgram program({SUNDOG_BINARY, "serve", "scene.json", "--token-file", "kept"}, folder.path());
    program.line_with("http://");
    BackgroundProgram again({SUNDOG_BINARY, "serve", "scene.json", "--token-file", "kept"}, folder.path());
    const std::string url = again.line_with("http://");
    CHECK(sundog::read_file(folder / "kept") == url.substr(url.find("token=") + 6) + "\n");
  }
  namespace fs = std::filesystem;
  CHECK(fs::status(folder / "kept").permissions() == (fs::perms::owner_read | fs::perms::owner_write));
  fs::permissions(folder / "kept", fs::perms::group_read, fs::perm_options::add);
  refused("kept");
  folder.write("other", "not a token\n");
  fs::permissions(folder / "other", fs::perms::owner_read | fs::perms::owner_write);
  refused("other");
}

TEST_CASE("--host adds a name for a tunnel; --port and --host are checked") {
  const TemporaryFolder folder;
  folder.write("scene.json", viewer_scene);
  BackgroundProgram program({SUNDOG_BINARY, "serve", "scene.json", "--host", "far.example:9000"},
                            folder.path());
  const std::string url = program.line_with("http://");
  const int port = std::stoi(url.substr(url.find(':', 7) + 1));
  CHECK(http(port, "GET / HTTP/1.1\r\nHost: far.example:9000\r\nOrigin: http://far.example:9000\r\n\r\n")
            .status == 200);
  CHECK(http(port, "GET / HTTP/1.1\r\nHost: far.example:9001\r\n\r\n").status == 421);
  CHECK(run_sundog({"serve", "--port", "70000"}).status == 2);
  for (const char* host : {"http://far.example", "far.example/", ":80", "far.example:", "far.example:0",
                           "far.example:65536", "::1", "[::1"}) {
    INFO(host);
    const CommandResult refused = run_sundog({"serve", "--host", host});
    CHECK(refused.status == 2);
    CHECK(refused.err.find("wanted NAME or NAME:PORT") != std::string::npos);
  }
  const CommandResult taken =
      run_sundog({"serve", (folder / "scene.json").string(), "--port", std::to_string(port)});
  CHECK(taken.status == 1);
  CHECK(taken.err.find("--port") != std::string::npos);
  CHECK(run_sundog({"serve", (folder / "none.json").string()}).status == 3);
}

TEST_CASE(
    "the pictures that the viewer saves are those of render: tone-mapped, with alpha where the scene is "
    "transparent") {
  json scene = json::parse(viewer_scene);
  scene["image"]["transparent"] = true;
  scene["image"]["tone_map"] = {{"curve", "reinhard"}, {"exposure", 1}};
  const std::string text = scene.dump();
  const Served viewer(text.c_str());
  for (const char* format : {"png", "exr"}) {
    INFO(format);
    HttpReply saved;
    for (int tries = 0; tries < 300 && saved.status != 200; ++tries) {
      std::this_thread::sleep_for(std::chrono::milliseconds(100));
      saved = http(viewer.port, http_request(viewer.port, "GET", std::string("/api/picture?format=") + format,
                                             viewer.with_token()));
    }
    REQUIRE(saved.status == 200);
    const std::string file = (viewer.folder / (std::string("a.") + format)).string();
    REQUIRE(run_sundog({"render", viewer.scene, "-o", file}).status == 0);
    CHECK((saved.body == sundog::read_file(file)));
  }
}
