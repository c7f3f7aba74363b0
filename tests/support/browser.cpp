// Drives chromium through chromedriver's WebDriver protocol.
#include "browser.h"

#include <chrono>
#include <stdexcept>
#include <string_view>
#include <thread>

#include "http_client.h"

using nlohmann::json;

namespace {

constexpr std::string_view letters = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";

int port_of(const std::string& line) {
  const std::size_t at = line.find("on port ");
  return at == std::string::npos ? 0 : std::stoi(line.substr(at + 8));
}

std::string from_base64(const std::string& text) {
  std::string bytes;
  unsigned bits = 0, count = 0;
  for (const char c : text) {
    const std::size_t value = letters.find(c);
    if (value == std::string::npos) continue;
    bits = bits << 6 | static_cast<unsigned>(value);
    if ((count += 6) < 8) continue;
    count -= 8;
    bytes += static_cast<char>(bits >> count & 255);
  }
  return bytes;
}

}  // namespace

std::string to_base64(const std::string& bytes) {
  std::string text;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    unsigned bits = 0;
    for (std::size_t k = 0; k < 3; ++k)
      bits = bits << 8 | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0U);
    for (unsigned k = 0; k < 4; ++k) text += i + k > bytes.size() ? '=' : letters[bits >> (18 - 6 * k) & 63];
  }
  return text;
}

Browser::Browser(int width, int height) : driver_({"chromedriver", "--port=0"}, profile_.path()) {
  try {
    port_ = port_of(driver_.line_with("successfully on port", 20));
  } catch (const std::runtime_error&) {
    throw std::runtime_error(
        "chromedriver does not start: install chromium and chromium-driver (./test.sh does)");
  }
  const json arguments = {"--headless=new",
                          "--no-sandbox",
                          "--disable-gpu",
                          "--disable-dev-shm-usage",
                          "--no-first-run",
                          "--window-size=" + std::to_string(width) + "," + std::to_string(height),
                          "--user-data-dir=" + profile_.path().string()};
  const json options = {{"args", arguments},
                        {"prefs",
                         {{"download.default_directory", downloads_.path().string()},
                          {"download.prompt_for_download", false},
                          {"profile.default_content_setting_values.automatic_downloads", 1}}}};
  const json wanted = {{"browserName", "chrome"},
                       {"acceptInsecureCerts", true},
                       {"goog:chromeOptions", options},
                       {"goog:loggingPrefs", {{"browser", "ALL"}}}};
  session_ = command("POST", "", {{"capabilities", {{"alwaysMatch", wanted}}}})["sessionId"];
  command("POST", "/timeouts", {{"script", 150000}});
  resize(width, height);
}

Browser::~Browser() {
  try {
    command("DELETE", "");
  } catch (const std::exception&) {
    driver_.end();  // ends the browser too
  }
}

json Browser::command(const std::string& method, const std::string& path, const json& body) {
  const std::string text = method == "POST" ? body.dump() : "";
  const std::string place = "/session" + (session_.empty() ? "" : "/" + session_) + path;
  const TcpClient client(port_, 90);
  const HttpReply reply =
      http(client, http_request(port_, method, place, "Content-Type: application/json\r\n", text));
  const json answer = json::parse(reply.body, nullptr, false);
  if (reply.status != 200)
    throw std::runtime_error("WebDriver " + path + ": " +
                             (answer.is_object() ? answer["value"].value("message", "") : reply.body));
  return answer["value"];
}

void Browser::type(const std::string& text, int gap) {
  json steps = json::array();
  for (const char c : text) {
    const std::string key(1, c);
    steps.push_back({{"type", "keyDown"}, {"value", key}});
    steps.push_back({{"type", "keyUp"}, {"value", key}});
    steps.push_back({{"type", "pause"}, {"duration", gap}});
  }
  perform({{{"type", "key"}, {"id", "keys"}, {"actions", steps}}});
}

/// Sets the size of the page, not of the window around it.
void Browser::resize(int width, int height) {
  for (int tries = 0; tries < 2; ++tries) {
    const json rest =
        run("return [window.outerWidth - window.innerWidth, window.outerHeight - window.innerHeight]");
    command("POST", "/window/rect",
            {{"width", width + rest[0].get<int>()}, {"height", height + rest[1].get<int>()}});
  }
}

json Browser::run(const std::string& script, const json& arguments) {
  const std::string whole =
      "const done = arguments[arguments.length - 1];"
      "(async (args) => {" +
      script + "})(Array.from(arguments)).then((value) => done([value]), (error) => done(String(error)))";
  const json value = command("POST", "/execute/async", {{"script", whole}, {"args", arguments}});
  if (value.is_string()) throw std::runtime_error("in the page: " + value.get<std::string>());
  return value[0];
}

void Browser::wait_until(const std::string& script, double seconds) {
  const json reached =
      run("const end = performance.now() + 1000 * args[0]; while (performance.now() < end) {"
          "if (await (async () => {" +
              script + "})()) return true; await new Promise((r) => setTimeout(r, 20)); } return false;",
          {seconds});
  if (reached != true) throw std::runtime_error("in vain the page was watched for: " + script);
}

void Browser::perform(const json& actions) {
  command("POST", "/actions", {{"actions", actions}});
  command("DELETE", "/actions");
}

void Browser::drag(const std::vector<std::pair<int, int>>& points, const std::string& modifier) {
  json pointer = json::array(), key = json::array();
  const auto step = [&](json one, json beside = {{"type", "pause"}}) {
    pointer.push_back(std::move(one)), key.push_back(std::move(beside));
  };
  if (!modifier.empty()) step({{"type", "pause"}}, {{"type", "keyDown"}, {"value", modifier}});
  step({{"type", "pointerMove"}, {"x", points[0].first}, {"y", points[0].second}, {"duration", 0}});
  step({{"type", "pointerDown"}, {"button", 0}});
  for (std::size_t i = 1; i < points.size(); ++i)
    step({{"type", "pointerMove"}, {"x", points[i].first}, {"y", points[i].second}, {"duration", 60}});
  step({{"type", "pointerUp"}, {"button", 0}});
  if (!modifier.empty()) step({{"type", "pause"}}, {{"type", "keyUp"}, {"value", modifier}});
  perform({{{"type", "key"}, {"id", "keys"}, {"actions", key}},
           {{"type", "pointer"}, {"id", "mouse"}, {"actions", pointer}}});
}

void Browser::double_click(int x, int y) {
  const json down = {{"type", "pointerDown"}, {"button", 0}}, up = {{"type", "pointerUp"}, {"button", 0}};
  const json to = {{"type", "pointerMove"}, {"x", x}, {"y", y}, {"duration", 0}};
  perform({{{"type", "pointer"}, {"id", "mouse"}, {"actions", {to, down, up, down, up}}}});
}

void Browser::touch(const std::vector<std::vector<std::pair<int, int>>>& fingers) {
  json all = json::array();
  for (std::size_t i = 0; i < fingers.size(); ++i) {
    json steps = json::array();
    for (const auto& [x, y] : fingers[i]) {
      steps.push_back({{"type", "pointerMove"}, {"x", x}, {"y", y}, {"duration", steps.empty() ? 0 : 60}});
      if (steps.size() == 1) steps.push_back({{"type", "pointerDown"}, {"button", 0}});
    }
    steps.push_back({{"type", "pointerUp"}, {"button", 0}});
    all.push_back({{"type", "pointer"},
                   {"id", "finger" + std::to_string(i)},
                   {"parameters", {{"pointerType", "touch"}}},
                   {"actions", steps}});
  }
  perform(all);
}

void Browser::prefer_dark(bool dark) {
  const json scheme = {{"name", "prefers-color-scheme"}, {"value", dark ? "dark" : "light"}};
  command("POST", "/goog/cdp/execute",
          {{"cmd", "Emulation.setEmulatedMedia"}, {"params", {{"features", {scheme}}}}});
}

void Browser::keys(const std::vector<std::string>& keys) {
  json steps = json::array();
  for (const std::string& key : keys) steps.push_back({{"type", "keyDown"}, {"value", key}});
  for (auto key = keys.rbegin(); key != keys.rend(); ++key)
    steps.push_back({{"type", "keyUp"}, {"value", *key}});
  perform({{{"type", "key"}, {"id", "keys"}, {"actions", steps}}});
}

void Browser::open_tab(const std::string& url) {
  const json tab = command("POST", "/window/new", {{"type", "tab"}});
  command("POST", "/window", {{"handle", tab["handle"]}});
  open(url);
}

void Browser::use_tab(std::size_t index) {
  command("POST", "/window", {{"handle", command("GET", "/window/handles")[index]}});
}

std::size_t Browser::tabs() { return command("GET", "/window/handles").size(); }

std::string Browser::screenshot() { return from_base64(command("GET", "/screenshot").get<std::string>()); }

std::vector<std::string> Browser::errors() {
  std::vector<std::string> all;
  for (const json& entry : command("POST", "/se/log", {{"type", "browser"}}))
    if (entry["level"] == "SEVERE") all.push_back(entry["message"]);
  return all;
}
