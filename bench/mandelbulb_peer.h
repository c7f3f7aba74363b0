// The benchmark's picture of a Mandelbulb of power 8 by hand-written C++: the algorithm of kernels/lib/sdf
// (the same estimate, relaxed marching, gradient from four estimates, openness and soft shadow), once for one
// pixel at a time, once for 16 with omp simd.
#pragma once
#include <cstddef>
#include <vector>

struct Picture {
  int width = 640, height = 640, iterations = 8;
  float bailout = 16, least = 1e-4f, greatest = 0.1f, detail = 0.5f;
  int step_limit = 512;
  float bound = 1.25f;  // half size of the interval
  float origin[3], right[3], up[3], forward[3], light[3];
  float half_angle = 0.5f;  // tangent
};

/// One thread; `shades` receives width * height values.
void render_scalar(const Picture& picture, std::vector<float>& shades);
void render_simd(const Picture& picture, std::vector<float>& shades);
