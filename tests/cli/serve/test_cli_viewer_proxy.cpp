// The viewer's page behind a proxy with https, as people reach a server on another machine.
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "catch.h"
#include "run_command.h"
#include "viewing.h"

using nlohmann::json;

namespace {

/// Passes bytes on from https at one port to the server at another; in requests, a third argument becomes the
/// fourth.
constexpr const char* proxy_script = R"(
import asyncio, ssl, sys
port, server_port, change = int(sys.argv[1]), int(sys.argv[2]), [word.encode() for word in sys.argv[3:]]
context = ssl.SSLContext(ssl.PROTOCOL_TLS_SERVER)
context.load_cert_chain('cert.pem', 'key.pem')

async def pass_on(reader, writer, change=[]):
    try:
        while some := await reader.read(65536):
            writer.write(some.replace(*change) if change else some)
            await writer.drain()
    except OSError:
        pass
    writer.close()

async def serve(reader, writer):
    try:
        to_reader, to_writer = await asyncio.open_connection('127.0.0.1', server_port)
    except OSError:
        return writer.close()
    await asyncio.gather(pass_on(reader, to_writer, change), pass_on(to_reader, writer))

async def main():
    server = await asyncio.start_server(serve, '127.0.0.1', port, ssl=context)
    print('listens', flush=True)
    await server.serve_forever()

asyncio.run(main())
)";

/// A server behind such a proxy, and the address of its page there.
struct Proxied {
  /// `old` in requests becomes `made`.
  explicit Proxied(const std::string& old = "", const std::string& made = "") {
    CommandOptions here;
    here.folder = folder.path();
    const CommandResult certified =
        run_command({"openssl", "req", "-x509", "-newkey", "rsa:2048", "-nodes", "-keyout", "key.pem", "-out",
                     "cert.pem", "-days", "2", "-subj", "/CN=localhost"},
                    here);
    INFO(certified.err);
    REQUIRE(certified.status == 0);
    folder.write("proxy.py", proxy_script);
    folder.write("scene.json", viewer_scene);
    const std::vector<std::string> serve = {SUNDOG_BINARY, "serve", "scene.json", "--host", host};
    server = std::make_unique<BackgroundProgram>(serve, folder.path());
    const std::string printed = server->line_with("http://");
    const std::size_t colon = printed.find(':', 7), slash = printed.find('/', 7);
    std::vector<std::string> pass = {"python3", "proxy.py", std::to_string(port),
                                     printed.substr(colon + 1, slash - colon - 1)};
    if (!old.empty()) pass.insert(pass.end(), {old, made});
    proxy = std::make_unique<BackgroundProgram>(pass, folder.path());
    proxy->line_with("listens");
    url = "https://" + host + printed.substr(slash);
  }

  TemporaryFolder folder;
  int port = free_port();
  std::string host = "localhost:" + std::to_string(port), url;
  std::unique_ptr<BackgroundProgram> server, proxy;
};

}  // namespace

TEST_CASE("behind a proxy with https the page has its socket too, and draws") {
  const Proxied proxied;
  Viewer& v = viewer();
  v.browser.open_tab(proxied.url);
  v.settle();
  CHECK(v.run("return [location.protocol, document.querySelector('.status').dataset.state]") ==
        json({"https:", "settled"}));
  v.browser.use_tab(0);
}

TEST_CASE("a page whose socket does not arrive says why and what mends it") {
  const Proxied proxied("Upgrade: websocket", "Upgrade: none");
  Viewer& v = viewer();
  v.browser.open_tab(proxied.url);
  v.wait("return document.querySelector('.toast.bad')", 15);
  CHECK(v.run("return document.querySelector('.toast.bad').textContent") ==
        "Cannot connect: wanted a WebSocket; a proxy has to pass the page's on, with its headers Upgrade and "
        "Connection");
  CHECK(v.run("return document.querySelector('.doing').textContent") == "cannot connect: it is tried again…");
  v.browser.use_tab(0);
}

TEST_CASE("a page that is refused as another's says what mends it") {
  const Proxied proxied("Origin: https://", "Origin: https://proxy.");
  Viewer& v = viewer();
  v.browser.open_tab(proxied.url);
  v.browser.wait_until("return document.querySelector('.notice').textContent.startsWith('Cannot connect')",
                       15);
  CHECK(v.browser.run("return document.querySelector('.notice').textContent")
            .get<std::string>()
            .find("sundog serve --host NAME or --host NAME:PORT") != std::string::npos);
  v.browser.use_tab(0);
}
