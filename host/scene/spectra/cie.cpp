// Holds the tables, integrates with the trapezoidal rule, and scales weights so that D65 is white; black
// bodies follow Planck's law and have luminance 1.
#include "scene/spectra/cie.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace sundog {
namespace {

// x, y, z of the 1931 standard observer, and D65, from 380 to 780 nm in steps of 5.
constexpr std::array<CieRow, SPECTRUM_ROWS> rows{
    {{0.001368, 3.9e-05, 0.00645, 49.9755}, {0.002236, 6.4e-05, 0.01055, 52.3118},
     {0.004243, 0.00012, 0.02005, 54.6482}, {0.00765, 0.000217, 0.03621, 68.7015},
     {0.01431, 0.000396, 0.06785, 82.7549}, {0.02319, 0.00064, 0.1102, 87.1204},
     {0.04351, 0.00121, 0.2074, 91.486},    {0.07763, 0.00218, 0.3713, 92.4589},
     {0.13438, 0.004, 0.6456, 93.4318},     {0.21477, 0.0073, 1.03905, 90.057},
     {0.2839, 0.0116, 1.3856, 86.6823},     {0.3285, 0.01684, 1.62296, 95.7736},
     {0.34828, 0.023, 1.74706, 104.865},    {0.34806, 0.0298, 1.7826, 110.936},
     {0.3362, 0.038, 1.77211, 117.008},     {0.3187, 0.048, 1.7441, 117.41},
     {0.2908, 0.06, 1.6692, 117.812},       {0.2511, 0.0739, 1.5281, 116.336},
     {0.19536, 0.09098, 1.28764, 114.861},  {0.1421, 0.1126, 1.0419, 115.392},
     {0.09564, 0.13902, 0.81295, 115.923},  {0.05795, 0.1693, 0.6162, 112.367},
     {0.03201, 0.20802, 0.46518, 108.811},  {0.0147, 0.2586, 0.3533, 109.082},
     {0.0049, 0.323, 0.272, 109.354},       {0.0024, 0.4073, 0.2123, 108.578},
     {0.0093, 0.503, 0.1582, 107.802},      {0.0291, 0.6082, 0.1117, 106.296},
     {0.06327, 0.71, 0.07825, 104.79},      {0.1096, 0.7932, 0.05725, 106.239},
     {0.1655, 0.862, 0.04216, 107.689},     {0.22575, 0.91485, 0.02984, 106.047},
     {0.2904, 0.954, 0.0203, 104.405},      {0.3597, 0.9803, 0.0134, 104.225},
     {0.43345, 0.99495, 0.00875, 104.046},  {0.51205, 1, 0.00575, 102.023},
     {0.5945, 0.995, 0.0039, 100},          {0.6784, 0.9786, 0.00275, 98.1671},
     {0.7621, 0.952, 0.0021, 96.3342},      {0.8425, 0.9154, 0.0018, 96.0611},
     {0.9163, 0.87, 0.00165, 95.788},       {0.9786, 0.8163, 0.0014, 92.2368},
     {1.0263, 0.757, 0.0011, 88.6856},      {1.0567, 0.6949, 0.001, 89.3459},
     {1.0622, 0.631, 0.0008, 90.0062},      {1.0456, 0.5668, 0.0006, 89.8026},
     {1.0026, 0.503, 0.00034, 89.5991},     {0.9384, 0.4412, 0.00024, 88.6489},
     {0.85445, 0.381, 0.00019, 87.6987},    {0.7514, 0.321, 0.0001, 85.4936},
     {0.6424, 0.265, 5e-05, 83.2886},       {0.5419, 0.217, 3e-05, 83.4939},
     {0.4479, 0.175, 2e-05, 83.6992},       {0.3608, 0.1382, 1e-05, 81.863},
     {0.2835, 0.107, 0, 80.0268},           {0.2187, 0.0816, 0, 80.1207},
     {0.1649, 0.061, 0, 80.2146},           {0.1212, 0.04458, 0, 81.2462},
     {0.0874, 0.032, 0, 82.2778},           {0.0636, 0.0232, 0, 80.281},
     {0.04677, 0.017, 0, 78.2842},          {0.0329, 0.01192, 0, 74.0027},
     {0.0227, 0.00821, 0, 69.7213},         {0.01584, 0.005723, 0, 70.6652},
     {0.011359, 0.004102, 0, 71.6091},      {0.008111, 0.002929, 0, 72.979},
     {0.00579, 0.002091, 0, 74.349},        {0.004109, 0.001484, 0, 67.9765},
     {0.002899, 0.001047, 0, 61.604},       {0.002049, 0.00074, 0, 65.7448},
     {0.00144, 0.00052, 0, 69.8856},        {0.001, 0.000361, 0, 72.4863},
     {0.00069, 0.000249, 0, 75.087},        {0.000476, 0.000172, 0, 69.3398},
     {0.000332, 0.00012, 0, 63.5927},       {0.000235, 8.5e-05, 0, 55.0054},
     {0.000166, 6e-05, 0, 46.4182},         {0.000117, 4.2e-05, 0, 56.6118},
     {8.3e-05, 3e-05, 0, 66.8054},          {5.9e-05, 2.1e-05, 0, 65.0941},
     {4.2e-05, 1.5e-05, 0, 63.3828}}};

dvec3 linear_rgb(const CieRow& row) {
  return dvec3(3.2404542 * row.x - 1.5371385 * row.y - 0.4985314 * row.z,
               -0.9692660 * row.x + 1.8760108 * row.y + 0.0415560 * row.z,
               0.0556434 * row.x - 0.2040259 * row.y + 1.0572252 * row.z);
}

RgbWeights make_weights() {
  RgbWeights weights;
  dvec3 sum(0);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    weights[i] = linear_rgb(rows[i]) * rows[i].d65;
    const bool end = i == 0 || i + 1 == rows.size();
    sum += weights[i] * static_cast<double>(SPECTRUM_STEP) * (end ? 0.5 : 1.0);
  }
  for (dvec3& weight : weights) weight /= sum;
  return weights;
}

}  // namespace

std::span<const CieRow, SPECTRUM_ROWS> cie_rows() { return rows; }

const RgbWeights& rgb_weights() {
  static const RgbWeights weights = make_weights();
  return weights;
}

dvec3 rgb_weight(double wavelength) {
  const double at = (wavelength - static_cast<double>(SPECTRUM_FIRST)) / static_cast<double>(SPECTRUM_STEP);
  if (!(at >= 0 && at <= static_cast<double>(SPECTRUM_ROWS - 1))) return dvec3(0);
  const auto row = std::min(static_cast<std::size_t>(at), std::size_t{SPECTRUM_ROWS - 2});
  return glm::mix(rgb_weights()[row], rgb_weights()[row + 1], at - static_cast<double>(row));
}

dvec3 black_body_color(double kelvin) {
  constexpr double second_constant = 1.438776877e7;  // hc / k in nm K
  dvec3 color(0);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const double nm =
        static_cast<double>(SPECTRUM_FIRST) + static_cast<double>(i) * static_cast<double>(SPECTRUM_STEP);
    color += linear_rgb(rows[i]) * std::pow(nm / 560, -5) * std::expm1(second_constant / (560 * kelvin)) /
             std::expm1(second_constant / (nm * kelvin));
  }
  color = glm::max(color, dvec3(0));
  return color / glm::dot(color, dvec3(0.2126, 0.7152, 0.0722));
}

}  // namespace sundog
