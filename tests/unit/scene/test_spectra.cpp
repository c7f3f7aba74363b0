// Spectra: daylight and the eye, colours as spectra, indices of refraction.
#include <array>
#include <cmath>

#include "catch.h"
#include "models/values/refraction.h"
#include "scene/spectra/upsample.h"

using namespace sundog;

namespace {

using Catch::Matchers::WithinAbs;

std::array<double, SPECTRUM_ROWS> spectrum_of(const dvec3& color) {
  std::array<double, SPECTRUM_ROWS> spectrum{};
  for (std::size_t i = 0; i < spectrum.size(); ++i) spectrum[i] = glm::dot(color, spectral_basis()[i]);
  return spectrum;
}

double index_of(std::string_view name, double line) {
  const auto dispersion = find_substance(name);
  REQUIRE(dispersion);
  return index_at(*dispersion, 0, line);
}

TEST_CASE("Dispersion: daylight is white, and its wavelengths have their places") {
  dvec3 sum(0);
  for (double l = 380; l < 780; l += 0.5) sum += 0.25 * (rgb_weight(l) + rgb_weight(l + 0.5));
  for (int c = 0; c < 3; ++c) CHECK_THAT(sum[c], WithinAbs(1, 1e-9));
  CHECK(rgb_weight(379) == dvec3(0));
  CHECK(rgb_weight(781) == dvec3(0));
  const dvec3 red = rgb_weight(640), green = rgb_weight(530), blue = rgb_weight(450);
  CHECK((red.x > 0 && red.y < red.x / 4 && red.z < red.x / 4));
  CHECK((green.y > 0 && green.x < 0 && green.z < green.y / 4));
  CHECK((blue.z > 0 && blue.x < blue.z / 4 && blue.y < 0));
  // CIE 15: the chromaticity of D65.
  dvec3 xyz(0);
  for (const CieRow& row : cie_rows()) xyz += row.d65 * dvec3(row.x, row.y, row.z);
  CHECK_THAT(xyz.x / (xyz.x + xyz.y + xyz.z), WithinAbs(0.3127, 1e-4));
  CHECK_THAT(xyz.y / (xyz.x + xyz.y + xyz.z), WithinAbs(0.3290, 1e-4));
}

TEST_CASE("Dispersion: colours come back from their spectra") {
  for (const dvec3& color : {dvec3(1, 0, 0), dvec3(0, 1, 0), dvec3(0, 0, 1), dvec3(1, 1, 1), dvec3(0, 0, 0),
                             dvec3(0.2, 0.7, 0.1), dvec3(12, 3, 0.5), dvec3(0.9, 0.9, 0)}) {
    const dvec3 seen = color_of(spectrum_of(color));
    for (int c = 0; c < 3; ++c) CHECK_THAT(seen[c], WithinAbs(color[c], 1e-9 * (1 + color.x)));
  }
}

TEST_CASE("Dispersion: no spectrum of a colour leaves what colours have, and white is flat") {
  for (const dvec3& parts : spectral_basis()) {
    CHECK((parts.x >= 0 && parts.y >= 0 && parts.z >= 0));
    CHECK_THAT(parts.x + parts.y + parts.z, WithinAbs(1, 1e-12));
  }
  // Red is at the long end, blue at the short one, green between.
  const auto at = [](double l) { return spectral_basis()[static_cast<std::size_t>((l - 380) / 5)]; };
  CHECK(at(650).x > 0.99);
  CHECK(at(540).y > 0.95);
  CHECK(at(445).z > 0.95);
}

TEST_CASE("a black body at 2856 K is the illuminant A, and redder ones lose their blue") {
  const dvec3 a = black_body_color(2856);  // CIE 15:2004: X, Y, Z = 1.09850, 1, 0.35585
  CHECK_THAT(a.x, WithinAbs(1.8451, 0.005));
  CHECK_THAT(a.y, WithinAbs(0.8261, 0.003));
  CHECK_THAT(a.z, WithinAbs(0.2333, 0.003));
  CHECK(black_body_color(1000).z == 0);
  CHECK(black_body_color(1e5).z > black_body_color(1e5).x);
}

TEST_CASE("Dispersion: the catalogue's indices at F, d and C are those of the data sheets") {
  struct Known {
    const char* name;
    double f, d, c, within;
  };
  // SCHOTT's data sheets; Malitson 1965; Daimon and Masumura 2007; Warren and Brandt 2008 (interpolated);
  // Peter 1923.
  constexpr Known all[] = {
      {"BK7", 1.52238, 1.51680, 1.51432, 6e-6},   {"SF10", 1.74648, 1.72825, 1.72085, 6e-6},
      {"F2", 1.63208, 1.62004, 1.61503, 6e-6},    {"fused_silica", 1.46313, 1.45846, 1.45637, 6e-6},
      {"water", 1.33749, 1.33340, 1.33151, 6e-6}, {"ice", 1.3137, 1.3098, 1.3079, 1e-4},
      {"diamond", 2.4354, 2.4175, 2.4099, 2e-4}};
  for (const Known& known : all) {
    INFO(known.name);
    CHECK_THAT(index_of(known.name, line_F), WithinAbs(known.f, known.within));
    CHECK_THAT(index_of(known.name, line_d), WithinAbs(known.d, known.within));
    CHECK_THAT(index_of(known.name, line_C), WithinAbs(known.c, known.within));
  }
  CHECK(std::size(all) == substances().size());
  CHECK_FALSE(find_substance("bk7"));
}

TEST_CASE("Dispersion: Abbe's number comes back from Cauchy's formula") {
  for (const double abbe : {20.0, 36.4, 64.2}) {
    const Dispersion made = cauchy_of_abbe(1.6, abbe);
    const double f = index_at(made, 0, line_F), d = index_at(made, 0, line_d), c = index_at(made, 0, line_C);
    CHECK_THAT(d, WithinAbs(1.6, 1e-12));
    CHECK_THAT((d - 1) / (f - c), WithinAbs(abbe, 1e-9));
  }
  CHECK(index_at({}, 1.5, 400) == 1.5);
}

}  // namespace
