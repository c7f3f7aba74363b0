// Runs the translator for lanes on text, and returns its text or its error.
#include "plain_text.h"

#include "base/error.h"
#include "catch.h"
#include "device/embedded_kernels.h"
#include "lanes/lanes.h"

namespace plain_text {

std::string in_lanes(const std::string& text, bool lines) {
  return sundog::spmd::Lanes([&](const std::string& path) {
           return path == "plain/t.cl" ? text : sundog::embedded_kernel(path);
         })
      .text("plain/t.cl", lines);
}

std::string refused(const std::string& text) {
  try {
    const std::string made = in_lanes(text);
    FAIL("not refused: " << text << "\nbut made: " << made);
  } catch (const sundog::BuildError& error) {
    return error.what();
  }
  return "";
}

std::string function(const std::string& body) {
  return "ENTRY static float f(float x, int k, UNIFORM int n, UNIFORM __global const float* q, float* o) "
         "{\n" +
         body + "\n}\n";
}

}  // namespace plain_text
