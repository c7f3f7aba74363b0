// Checks hosts, origins, methods and the token, which is compared in constant time. A file that stores the
// token must be accessible to the user only.
#include "app/serve/gate.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/random.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>

#include "base/error.h"
#include "base/file.h"
#include "base/names.h"
#include "base/numbers.h"

namespace sundog {

const std::string* RequestHead::header(std::string_view name) const {
  const auto found = headers.find(name);
  return found == headers.end() ? nullptr : &found->second;
}

std::string random_token() {
  std::array<unsigned char, 16> bytes{};
  if (::getrandom(bytes.data(), bytes.size(), 0) != static_cast<ssize_t>(bytes.size()))
    throw IoError("serve: the system gives no random bytes for the token");
  std::string token;
  for (const unsigned char byte : bytes) token += fmt::format("{:02x}", byte);
  return token;
}

std::string kept_token(const std::filesystem::path& file) {
  struct stat status = {};
  if (::stat(file.c_str(), &status) != 0) {
    const int descriptor = ::open(file.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0600);
    if (descriptor < 0)
      throw IoError(fmt::format("{}: cannot be made: {}", file.string(), std::strerror(errno)));
    const std::string token = random_token(), line = token + "\n";
    const bool written = ::write(descriptor, line.data(), line.size()) == static_cast<ssize_t>(line.size());
    if (::close(descriptor) != 0 || !written)
      throw IoError(fmt::format("{}: cannot be written: {}", file.string(), std::strerror(errno)));
    return token;
  }
  if ((status.st_mode & 077) != 0 || status.st_uid != ::geteuid())
    throw UsageError(fmt::format("--token-file {}: others may read it; wanted a file of yours with mode 600",
                                 file.string()));
  std::string token = read_file(file);
  if (token.ends_with('\n')) token.pop_back();
  if (token.size() != 32 || token.find_first_not_of("0123456789abcdef") != std::string::npos)
    throw UsageError(
        fmt::format("--token-file {}: holds no token; remove it, and a new one is made", file.string()));
  return token;
}

namespace {

constexpr int http_port = 80, https_port = 443;

void admit(Gate& gate, const std::string& scheme, const std::string& name, int port) {
  std::vector<std::string> hosts = {fmt::format("{}:{}", name, port)};
  if (port == (scheme == "http" ? http_port : https_port)) hosts.push_back(name);
  for (const std::string& host : hosts) {
    gate.hosts.push_back(host);
    gate.origins.push_back(fmt::format("{}://{}", scheme, host));
  }
}

}  // namespace

PublicName parse_public_name(const std::string& typed) {
  const std::size_t end = typed.starts_with('[') ? typed.find(']') : 0;
  const std::size_t colon = end == std::string::npos ? end : typed.find(':', end);
  const std::string name = typed.substr(0, colon);
  const bool with_port = colon != std::string::npos;
  const auto port = whole_number<int>(with_port ? std::string_view(typed).substr(colon + 1) : "0");
  if (name.empty() || name.starts_with('[') != name.ends_with(']') ||
      name.find_first_of("/?#@ ") != std::string::npos || !port || *port < 0 || *port > 65535 ||
      (with_port && *port == 0))
    throw UsageError(fmt::format(
        "--host {}: wanted NAME or NAME:PORT, without http://, as the browser's address line has it", typed));
  return {lower_case(name), with_port ? std::vector{*port} : std::vector{http_port, https_port}};
}

Gate make_gate(int port, std::string token, const std::vector<PublicName>& further) {
  Gate gate{std::move(token), {}, {}};
  for (const char* name : {"127.0.0.1", "localhost", "[::1]"}) admit(gate, "http", name, port);
  for (const PublicName& one : further)
    for (const int reached : one.ports)
      for (const char* scheme : {"http", "https"}) admit(gate, scheme, one.name, reached);
  return gate;
}

bool equal_in_constant_time(std::string_view a, std::string_view b) {
  if (a.size() != b.size()) return false;
  unsigned difference = 0;
  for (std::size_t i = 0; i < a.size(); ++i)
    difference |= static_cast<unsigned char>(a[i]) ^ static_cast<unsigned char>(b[i]);
  return difference == 0;
}

Refusal check_request(const Gate& gate, const RequestHead& head) {
  const std::string* host = head.header("host");
  if (!host || head.repeated_host || std::ranges::count(gate.hosts, lower_case(*host)) == 0)
    return {421,
            "this server does not answer to that Host; a tunnel or proxy wants sundog serve --host NAME "
            "or --host NAME:PORT, as the browser's address line has it"};
  const std::string* origin = head.header("origin");
  if (origin && std::ranges::count(gate.origins, *origin) == 0)
    return {403,
            "requests from other pages are refused; a page behind a tunnel or proxy wants sundog serve "
            "--host NAME or --host NAME:PORT, as the browser's address line has it"};
  const bool api = head.path.starts_with("/api/");
  const bool posts = api || head.path == socket_path;  // POST to it tells a page why its socket is refused
  if (head.method != "GET" && !(posts && head.method == "POST"))
    return {405, "this method is not taken here", posts ? "GET, HEAD, POST" : "GET, HEAD"};
  const std::string* token = head.header(token_header);
  if (api && !(token && equal_in_constant_time(*token, gate.token)))
    return {401, "the token is missing or wrong: open the URL that `sundog serve` has printed"};
  return {};
}

std::string query_value(std::string_view query, std::string_view key) {
  while (!query.empty()) {
    const std::string_view part = query.substr(0, query.find('&'));
    query.remove_prefix(std::min(query.size(), part.size() + 1));
    const std::size_t equals = part.find('=');
    if (part.substr(0, equals) != key) continue;
    std::string value(equals == std::string_view::npos ? "" : part.substr(equals + 1));
    std::ranges::replace(value, '+', ' ');
    return percent_decoded(value);
  }
  return "";
}

}  // namespace sundog
