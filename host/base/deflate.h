// zlib streams (RFC 1950) at libdeflate's fastest level.
#pragma once
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

namespace sundog {

std::string deflated(std::string_view bytes);

/// Unpacks `size` bytes; none if `packed` is damaged or unpacks to another size.
std::optional<std::string> inflated(std::string_view packed, std::size_t size);

}  // namespace sundog
