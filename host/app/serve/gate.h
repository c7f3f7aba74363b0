// Admits requests to the viewer's server. A request must name this server as its Host and one of its pages as
// its Origin, if any; calls also need the token. Only calls and the socket's path accept POST. Needs no
// socket or clock.
#pragma once
#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace sundog {

/// A request's head; HEAD is treated as GET. Header names are in lower case. `repeated_host`: Host, Origin or
/// the token occurs more than once.
struct RequestHead {
  std::string method, path;  // the path without its query
  std::string query;
  std::map<std::string, std::string, std::less<>> headers;
  bool repeated_host = false;
  const std::string* header(std::string_view name) const;
};

/// Fixed when the server starts. `Host` and `Origin` are compared with these lists, never with each other:
/// they are equal if a foreign name is made to resolve to this machine (DNS rebinding).
struct Gate {
  std::string token;
  std::vector<std::string> hosts;    // "127.0.0.1:8123"
  std::vector<std::string> origins;  // "http://127.0.0.1:8123"
};

inline constexpr std::string_view token_header = "x-sundog-token";
inline constexpr std::string_view socket_path = "/ws";

/// 128 random bits from the system, as 32 hexadecimal digits. Throws IoError.
std::string random_token();

/// Reads the token from the file, or creates the file, readable by this user only, so that open pages
/// reconnect after a restart. Throws UsageError for other contents, or a file that others may read; IoError.
std::string kept_token(const std::filesystem::path& file);

/// A name by which browsers reach the server, and the ports that they connect to.
struct PublicName {
  std::string name;  // in lower case, as browsers send it; IPv6 addresses in brackets
  std::vector<int> ports;
};

/// "NAME:PORT", or "NAME" for the default ports of http and https. Throws UsageError.
PublicName parse_public_name(const std::string& typed);

/// The gate of a server at this port, which browsers reach by loopback names and by the `further` names of
/// tunnels and proxies. Admits names without a port too if it is the scheme's default, which browsers omit.
Gate make_gate(int port, std::string token, const std::vector<PublicName>& further);

/// Takes the same time wherever the strings differ.
bool equal_in_constant_time(std::string_view a, std::string_view b);

struct Refusal {
  int status = 0;  // HTTP status; 0: the request is admitted
  std::string reason;
  std::string allow = "GET, HEAD";  // methods that a 405 names
};

/// Checks everything except a socket's token, which is its first message.
Refusal check_request(const Gate& gate, const RequestHead& head);

/// The value of `key` in a query such as "format=png&x=1", with %XX decoded; empty if missing.
std::string query_value(std::string_view query, std::string_view key);

}  // namespace sundog
