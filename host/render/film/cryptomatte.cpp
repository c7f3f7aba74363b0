// Hashes names to float ids, splits pairs into layers of two, and writes the manifests; "default" stands for
// surfaces without an entry.
#include "render/film/cryptomatte.h"
#include "base/json_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <nlohmann/json.hpp>

namespace sundog {
namespace {

constexpr std::uint32_t first_factor = 0xcc9e2d51u, second_factor = 0x1b873593u;

std::uint32_t mixed(std::uint32_t block) { return std::rotl(block * first_factor, 15) * second_factor; }

/// Up to four bytes, the first lowest.
std::uint32_t block_of(std::string_view bytes) {
  std::uint32_t block = 0;
  for (std::size_t i = 0; i < bytes.size(); ++i)
    block |= static_cast<std::uint32_t>(static_cast<unsigned char>(bytes[i])) << (8 * i);
  return block;
}

/// Names unnamed entries by their index, so that each has its own id. Appends "default", for surfaces without
/// an entry.
std::vector<std::string> completed(std::vector<std::string> names, std::string_view kind) {
  for (std::size_t i = 0; i < names.size(); ++i)
    if (names[i].empty()) names[i] = fmt::format("{} {}", kind, i);
  names.emplace_back("default");
  return names;
}

/// Two of the pairs as a layer; unused pairs have id and share 0.
Image layer_of(const Image& pairs, std::size_t first, const std::vector<std::string>& names) {
  std::vector<float> ids;
  for (const std::string& name : names) ids.push_back(std::bit_cast<float>(id_bits(name)));
  Image layer(pairs.width, pairs.height, 4);
  for (std::size_t pixel = 0; pixel < layer.data.size() / 4; ++pixel)
    for (std::size_t pair = 0; pair < 2; ++pair) {
      const float* from = &pairs.data[static_cast<std::size_t>(pairs.channels) * pixel + 2 * (first + pair)];
      if (!(from[0] >= 0) || !(from[1] > 0)) continue;
      layer.data[4 * pixel + 2 * pair] = ids[std::min(static_cast<std::size_t>(from[0]), ids.size() - 1)];
      layer.data[4 * pixel + 2 * pair + 1] = from[1];
    }
  return layer;
}

std::string manifest_of(const std::vector<std::string>& names) {
  nlohmann::json manifest = nlohmann::json::object();
  for (const std::string& name : names) manifest[name] = fmt::format("{:08x}", id_bits(name));
  return json_text(manifest);
}

void split(AovImages& aovs, const std::string& kind, const std::vector<std::string>& known,
           ImageTexts& texts) {
  const std::string name = "crypto_" + kind;
  const auto found = aovs.find(name);
  if (found == aovs.end()) return;
  const std::vector<std::string> names = completed(known, kind);
  const Image pairs = std::move(found->second);
  aovs.erase(found);
  for (int layer = 0; layer < pairs.channels / 4; ++layer)
    aovs[fmt::format("{}{:02}", name, layer)] = layer_of(pairs, static_cast<std::size_t>(2 * layer), names);
  const std::string key = fmt::format("cryptomatte/{:.7}/", fmt::format("{:08x}", hash_name(name)));
  texts.emplace_back(key + "name", name);
  texts.emplace_back(key + "hash", "MurmurHash3_32");
  texts.emplace_back(key + "conversion", "uint32_to_float32");
  texts.emplace_back(key + "manifest", manifest_of(names));
}

}  // namespace

std::uint32_t hash_name(std::string_view name) {
  std::uint32_t hash = 0;
  std::string_view rest = name;
  for (; rest.size() >= 4; rest.remove_prefix(4))
    hash = std::rotl(hash ^ mixed(block_of(rest.substr(0, 4))), 13) * 5 + 0xe6546b64u;
  if (!rest.empty()) hash ^= mixed(block_of(rest));
  hash ^= static_cast<std::uint32_t>(name.size());
  hash = (hash ^ hash >> 16) * 0x85ebca6bu;
  hash = (hash ^ hash >> 13) * 0xc2b2ae35u;
  return hash ^ hash >> 16;
}

std::uint32_t id_bits(std::string_view name) {
  const std::uint32_t hash = hash_name(name);
  const std::uint32_t exponent = std::clamp((hash >> 23) & 0xffu, 1u, 254u);
  return (hash & 0x807fffffu) | exponent << 23;
}

ImageTexts name_cryptomattes(AovImages& aovs, const MatteNames& names) {
  ImageTexts texts;
  split(aovs, "object", names.objects, texts);
  split(aovs, "material", names.materials, texts);
  return texts;
}

}  // namespace sundog
