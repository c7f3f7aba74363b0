// Writes header, table and tags in the layout of ICC.1:2022 (profile version 4.4), which all readers of
// version 4 accept, with primaries adapted to D50.
#include "base/colors/icc_profile.h"

#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

#include "base/colors/color_space.h"

namespace sundog {
namespace {

std::string number(std::uint32_t value, int bytes = 4) {
  std::string text;
  for (int i = bytes; i-- > 0;) text += static_cast<char>(value >> (8 * i) & 255);
  return text;
}

/// Encodes an s15Fixed16Number.
std::string fixed(double value) {
  return number(static_cast<std::uint32_t>(static_cast<std::int32_t>(std::lround(value * 65536))));
}

std::string xyz(const glm::dvec3& v) { return "XYZ " + number(0) + fixed(v.x) + fixed(v.y) + fixed(v.z); }

/// Encodes an ASCII text in one language.
std::string text_tag(const std::string& text) {
  constexpr std::uint32_t begin = 28, record = 12;
  std::string tag = "mluc" + number(0) + number(1) + number(record) + "enUS" +
                    number(static_cast<std::uint32_t>(2 * text.size())) + number(begin);
  for (const char c : text) tag += {'\0', c};
  return tag;
}

/// The sRGB curve as a parametric curve of type 3: (a x + b)^g for x >= d, else c x.
std::string srgb_curve() {
  std::string tag = "para" + number(0) + number(3, 2) + number(0, 2);
  for (const double value : {2.4, 1 / 1.055, 0.055 / 1.055, 1 / 12.92, 0.04045}) tag += fixed(value);
  return tag;
}

std::string matrix_tag(const glm::dmat3& m) {
  std::string tag = "sf32" + number(0);
  for (int i = 0; i < 9; ++i) tag += fixed(m[i % 3][i / 3]);  // row by row
  return tag;
}

/// The header, the table of tags, and the tags, each at a multiple of four bytes.
std::string assembled(const glm::dvec3& white,
                      const std::vector<std::pair<std::string, std::vector<std::string>>>& tags) {
  std::size_t count = 0;
  for (const auto& [content, names] : tags) count += names.size();
  const std::size_t begin = 128 + 4 + 12 * count;
  std::string table = number(static_cast<std::uint32_t>(count)), data;
  for (const auto& [content, names] : tags) {
    for (const std::string& name : names)
      table += name + number(static_cast<std::uint32_t>(begin + data.size())) +
               number(static_cast<std::uint32_t>(content.size()));
    data += content + std::string((4 - content.size() % 4) % 4, '\0');
  }
  const std::string date = number(2026, 2) + number(1, 2) + number(1, 2) + std::string(6, '\0');
  const std::string header = number(static_cast<std::uint32_t>(begin + data.size())) + number(0) +
                             number(0x04400000) + "mntrRGB XYZ " + date + "acsp" + std::string(28, '\0') +
                             fixed(white.x) + fixed(white.y) + fixed(white.z) + std::string(48, '\0');
  return header + table + data;
}

}  // namespace

std::string srgb_icc_profile() {
  const glm::dvec3 d50(0.9642, 1, 0.8249);
  const double sum = d50.x + d50.y + d50.z;
  const glm::dmat3 to_d50 = adaptation(srgb_primaries.white, {d50.x / sum, d50.y / sum}),
                   colors = to_d50 * xyz_from(srgb_primaries);
  return assembled(d50, {{text_tag("sRGB"), {"desc"}},
                         {text_tag("No copyright, use freely"), {"cprt"}},
                         {xyz(d50), {"wtpt"}},
                         {matrix_tag(to_d50), {"chad"}},
                         {xyz(colors[0]), {"rXYZ"}},
                         {xyz(colors[1]), {"gXYZ"}},
                         {xyz(colors[2]), {"bXYZ"}},
                         {srgb_curve(), {"rTRC", "gTRC", "bTRC"}}});
}

}  // namespace sundog
