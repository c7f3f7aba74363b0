// Reads GLB files (glTF 2.0, section 4) and buffer URIs (RFC 3986, RFC 2397, RFC 4648).
#include "models/gltf/gltf_container.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>

#include "base/error.h"
#include "base/input.h"
#include "base/names.h"
#include "base/numbers.h"
#include "models/beside.h"

namespace sundog::models {
namespace fs = std::filesystem;
namespace {

constexpr std::uint32_t json_chunk = 0x4E4F534A, binary_chunk = 0x004E4942;

std::uint32_t word_at(const Source& source, std::size_t at) {
  if (source.bytes.size() < at + 4)
    fail_at_byte(source, source.bytes.size(), "the GLB file ends within a header");
  std::uint32_t word = 0;
  for (std::size_t i = 4; i-- > 0;) word = word << 8 | static_cast<unsigned char>(source.bytes[at + i]);
  return word;
}

GltfContainer open_glb(const Source& source) {
  const std::uint32_t version = word_at(source, 4), length = word_at(source, 8);
  if (version != 2) fail_at_byte(source, 4, fmt::format("GLB version {}; 2 is read", version));
  if (length > source.bytes.size())
    fail_at_byte(source, 8,
                 fmt::format("a length of {}, but the file has {} bytes", length, source.bytes.size()));
  if (length < 20) fail_at_byte(source, 8, fmt::format("a length of {} leaves no room for a chunk", length));
  GltfContainer container;
  int number = 0;
  for (std::size_t at = 12; at < length; ++number) {
    if (length - at < 8) fail_at_byte(source, at, "the file ends within a chunk's header");
    const std::size_t size = word_at(source, at);
    const std::uint32_t type = word_at(source, at + 4);
    if (size > length - at - 8)
      fail_at_byte(source, at, fmt::format("a chunk of {} bytes runs over the end", size));
    const std::string_view content = std::string_view(source.bytes).substr(at + 8, size);
    if ((number == 0) != (type == json_chunk))
      fail_at_byte(source, at, "the first chunk, and only that, must be JSON");
    if (type == binary_chunk && number != 1) fail_at_byte(source, at, "a BIN chunk must be the second one");
    if (type == json_chunk) container.json = content;
    if (type == binary_chunk) container.binary = content;
    at += 8 + size;
  }
  return container;
}

int digit_of(char c) {
  if (c >= 'A' && c <= 'Z') return c - 'A';
  if (c >= 'a' && c <= 'z') return c - 'a' + 26;
  if (c >= '0' && c <= '9') return c - '0' + 52;
  return c == '+' ? 62 : c == '/' ? 63 : -1;
}

std::string decode_base64(std::string_view text, const JsonAt& uri) {
  if (text.size() % 4 != 0) uri.fail("base64 data whose length is no multiple of 4");
  std::string bytes;
  bytes.reserve(text.size() / 4 * 3);
  const std::size_t padding = text.ends_with("==") ? 2 : text.ends_with("=") ? 1 : 0;
  for (std::size_t i = 0; i < text.size(); i += 4) {
    std::uint32_t bits = 0;
    const bool last = i + 4 == text.size();
    for (std::size_t k = 0; k < 4; ++k) {
      const bool padded = last && k >= 4 - padding;
      const int digit = padded ? 0 : digit_of(text[i + k]);
      if (digit < 0) uri.fail(fmt::format("base64 data has a wrong character, {} after its start", i + k));
      bits = bits << 6 | static_cast<std::uint32_t>(digit);
    }
    for (std::size_t k = 0; k < (last ? 3 - padding : 3); ++k)
      bytes += static_cast<char>(bits >> (16 - 8 * k) & 0xFF);
  }
  return bytes;
}

std::string read_data_uri(std::string_view text, const JsonAt& uri, bool buffer) {
  const std::size_t comma = text.find(',');
  if (comma == text.npos) uri.fail("a data URI without a comma");
  std::string head = lower_case(text.substr(5, comma - 5));
  const bool base64 = head.ends_with(";base64");
  if (base64) head.resize(head.size() - 7);
  // An image's type is recognised by its bytes.
  if (buffer && head != "application/octet-stream" && head != "application/gltf-buffer")
    uri.fail("a data URI of type application/octet-stream or application/gltf-buffer wanted");
  return base64 ? decode_base64(text.substr(comma + 1), uri) : percent_decoded(text.substr(comma + 1));
}

// The length of a URI's scheme, 0 without one; fails for a colon without a scheme.
std::size_t scheme_length(std::string_view text, const JsonAt& uri) {
  const std::size_t end = text.find_first_of(":/?#");
  if (end == text.npos || text[end] != ':') return 0;
  const auto allowed = [](unsigned char c) { return std::isalnum(c) || c == '+' || c == '-' || c == '.'; };
  if (end == 0 || !std::isalpha(static_cast<unsigned char>(text[0])) ||
      !std::all_of(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(end), allowed))
    uri.fail("not a URI");
  return end;
}

/// Calls step() and ignores errors, which are reported when the faulty part is used.
template <class Step>
void leniently(const Step& step) {
  try {
    step();
  } catch (const SceneError&) {
  }
}

void note_uri(const Source& source, const JsonAt& named) {
  const auto uri = named.find("uri");
  if (!uri) return;
  const std::string text = uri->text();
  if (scheme_length(text, *uri) == 0) note_file(source.path.parent_path() / fs::path(percent_decoded(text)));
}

}  // namespace

GltfContainer open_container(const Source& source) {
  GltfContainer container;
  if (model_extension(source.path) == ".glb" || source.bytes.starts_with("glTF")) {
    if (!source.bytes.starts_with("glTF"))
      fail_at_byte(source, 0, "not a GLB file: it must begin with 'glTF'");
    container = open_glb(source);
  } else {
    container.json = source.bytes;
  }
  if (container.json.starts_with(byte_order_mark))
    fail(source, "", "glTF's JSON must not begin with a byte order mark");
  return container;
}

void note_files(const Source& source, const JsonAt& root) {
  for (const char* key : {"images", "buffers"})
    leniently([&] {
      for (const JsonAt& at : root.list(key)) leniently([&] { note_uri(source, at); });
    });
}

std::optional<std::string> read_buffer_uri(const Source& source, const JsonAt& uri) {
  const std::string text = uri.text();
  if (text.starts_with("data:")) return read_data_uri(text, uri, true);
  if (scheme_length(text, uri) > 0) return std::nullopt;
  const fs::path folder = source.path.parent_path();
  const auto may_be_read = [&](const fs::path& path) {
    return source.outside_files || !leads_outside(source.path, path);
  };
  fs::path path = folder / fs::path(percent_decoded(text));
  // Some programs do not encode names that contain a '%'.
  std::error_code ignored;
  if (const fs::path plain = folder / fs::path(text);
      !fs::exists(path, ignored) && may_be_read(plain) && fs::exists(plain, ignored))
    path = plain;
  if (!may_be_read(path))
    uri.fail(fmt::format("'{}' leads out of the model's folder: {}", text, outside_hint),
             Remedy::outside_files);
  try {
    return read_source(path).bytes;
  } catch (const SceneError& error) {
    uri.fail(fmt::format("the buffer's file {} {}", path.string(), error.reason));
  }
}

std::string read_image_uri(const Source& source, const JsonAt& uri, std::vector<std::string>& warnings) {
  const std::string text = uri.text();
  if (text.starts_with("data:")) return read_data_uri(text, uri, false);
  const fs::path folder = source.path.parent_path();
  for (const std::string& name : {percent_decoded(text), text})
    if (const auto path = find_beside(source, folder, name, warnings)) return read_source(*path).bytes;
  uri.fail("the image " + why_not_beside(source, folder, percent_decoded(text)));
}

}  // namespace sundog::models
