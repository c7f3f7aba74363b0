// Admits requests to the viewer's server. A request must name this server as its Host, one of its pages as
// its Origin, and the token; requests that change nothing must use a method without effects. Pure: no socket,
// no clock.
#pragma once
#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace sundog {

/// A request before its body is read; HEAD is taken as GET. Header names are in lower case; one that came
/// twice is in `repeated`.
struct RequestHead {
  std::string method, path;  // the path without its query
  std::string query;
  std::map<std::string, std::string, std::less<>> headers;
  bool repeated_host = false;
  const std::string* header(std::string_view name) const;
};

/// Fixed when the server starts. `Host` and `Origin` are each compared with these lists, never with each
/// other: where a foreign name is made to lead to this machine (DNS rebinding), the two are equal.
struct Gate {
  std::string token;
  std::vector<std::string> hosts;    // "127.0.0.1:8123"
  std::vector<std::string> origins;  // "http://127.0.0.1:8123"
};

inline constexpr std::string_view token_header = "x-sundog-token";
inline constexpr std::string_view socket_path = "/ws";

/// 128 bits from the system's source, as 32 hexadecimal digits. Throws IoError.
std::string random_token();

/// The token that the file holds, which is made, for this user alone, where it is missing: pages that are
/// open come back to a server that is started anew. Throws UsageError for a file of anything else, or one
/// that others may read; IoError.
std::string kept_token(const std::filesystem::path& file);

/// A name by which browsers reach the server, and the ports that they connect to.
struct PublicName {
  std::string name;  // in lower case, as browsers send it; IPv6 addresses in brackets
  std::vector<int> ports;
};

/// "NAME:PORT", or "NAME" for the default ports of http and https. Throws UsageError.
PublicName parse_public_name(const std::string& typed);

/// The gate of a server at this port, which browsers reach by loopback names and by `further`, as through a
/// tunnel or a proxy. They leave out a scheme's default port.
Gate make_gate(int port, std::string token, const std::vector<PublicName>& further);

/// In a time that does not depend on where they differ.
bool equal_in_constant_time(std::string_view a, std::string_view b);

struct Refusal {
  int status = 0;  // of HTTP; 0: the request may pass
  std::string reason;
  std::string allow = "GET, HEAD";  // methods that a 405 names
};

/// Checks everything but a socket's token, which is its first message.
Refusal check_request(const Gate& gate, const RequestHead& head);

/// The value of `key` in a query such as "format=png&x=1", with %XX decoded; empty: none.
std::string query_value(std::string_view query, std::string_view key);

}  // namespace sundog
