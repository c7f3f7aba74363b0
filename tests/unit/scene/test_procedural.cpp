// Generated meshes: the same bits everywhere, closed, wound outward, and each surface inside the next.
#include <cmath>
#include <cstring>
#include <map>
#include <utility>

#include "catch.h"
#include "mesh_volume.h"
#include "scene/procedural/ice_block.h"
#include "scene/procedural/random.h"

using namespace sundog;
using glm::dvec3;

namespace {

IceBlock hollow_block(std::uint64_t seed = 7, int subdivision = 32) {
  IceBlock block;
  block.seed = seed;
  block.subdivision = subdivision;
  block.outer.size = {2, 1.7, 1.8};
  block.hollow = true;
  block.cavity = block.outer;
  block.cavity.size *= 0.65;
  block.cavity.softness = 2;
  return block;
}

template <class T>
void hash_in(std::uint64_t& hash, const MeshArray<T>& values) {  // FNV-1a
  const auto* bytes = reinterpret_cast<const unsigned char*>(values.data());
  for (std::size_t i = 0; i < values.size() * sizeof(T); i++) hash = (hash ^ bytes[i]) * 0x100000001B3ull;
}

std::uint64_t checksum(const Mesh& mesh) {
  std::uint64_t hash = 0xCBF29CE484222325ull;
  hash_in(hash, mesh.positions);
  hash_in(hash, mesh.normals);
  hash_in(hash, mesh.triangles);
  return hash;
}

// Directed edges that have not exactly one partner the other way round.
std::size_t open_edges(const Mesh& mesh) {
  std::map<std::pair<unsigned, unsigned>, int> count;
  for (const auto& t : mesh.triangles)
    for (const auto& [a, b] : {std::pair{t.x, t.y}, std::pair{t.y, t.z}, std::pair{t.z, t.x}})
      count[{a, b}]++;
  std::size_t bad = 0;
  for (const auto& [edge, n] : count) {
    const auto back = count.find({edge.second, edge.first});
    bad += n != 1 || back == count.end() || back->second != 1;
  }
  return bad;
}

// How often the surface winds around the point (Van Oosterom and Strackee 1983): 1 inside, 0 outside.
double winding(const Mesh& mesh, const dvec3& point) {
  double sum = 0;
  for (const auto& t : mesh.triangles) {
    const dvec3 a = dvec3(mesh.positions[t.x]) - point, b = dvec3(mesh.positions[t.y]) - point,
                c = dvec3(mesh.positions[t.z]) - point;
    const double la = glm::length(a), lb = glm::length(b), lc = glm::length(c);
    sum += 2 * std::atan2(glm::dot(a, glm::cross(b, c)),
                          la * lb * lc + glm::dot(a, b) * lc + glm::dot(b, c) * la + glm::dot(c, a) * lb);
  }
  return sum / (4 * 3.14159265358979323846);
}

bool contains(const Mesh& mesh, const dvec3& point) { return winding(mesh, point) > 0.5; }

}  // namespace

TEST_CASE("a generated block is the same to the bit on every machine", "[procedural]") {
  CHECK(checksum(make_ice(hollow_block())) == 0x7E4DF0C9449B58A2ull);
  CHECK(checksum(make_ice_liquid(hollow_block(), 0.1)) == 0x24EA78DE237D814Aull);
  CHECK(checksum(make_ice(hollow_block(8))) != checksum(make_ice(hollow_block())));
}

TEST_CASE("generated blocks and their liquid are closed and enclose a positive volume", "[procedural]") {
  for (const std::uint64_t seed : {1u, 2u, 3u, 4u, 5u, 6u, 7u, 8u}) {
    const IceBlock block = hollow_block(seed);
    IceBlock solid = block;
    solid.hollow = false;
    const Mesh hollow = make_ice(block), full = make_ice(solid), liquid = make_ice_liquid(block, 0.1);
    CHECK(full.triangles.size() == 12u * 32 * 32);
    CHECK(hollow.triangles.size() == 24u * 32 * 32);
    CHECK(open_edges(full) == 0);
    CHECK(open_edges(hollow) == 0);
    CHECK(open_edges(liquid) == 0);
    CHECK(volume(full) > 0.5 * 2 * 1.7 * 1.8);
    CHECK(volume(full) < 2 * 1.7 * 1.8);
    CHECK(volume(hollow) > 0.5 * volume(full));
    CHECK(volume(hollow) < 0.9 * volume(full));
    CHECK(volume(liquid) > 0);
    CHECK(volume(liquid) < 0.6 * volume(full));
  }
}

TEST_CASE("the cavity lies inside the block with a wall everywhere", "[procedural]") {
  const Mesh mesh = make_ice(hollow_block());
  const std::size_t half = mesh.positions.size() / 2;
  double thinnest = 1;
  for (std::size_t i = 0; i < half; i++) {
    const dvec3 outside(mesh.positions[i]), inside(mesh.positions[half + i]);
    // Both lie in the same direction from the origin, the cavity nearer.
    CHECK(glm::length(glm::cross(glm::normalize(outside), glm::normalize(inside))) < 1e-6);
    thinnest = std::min(thinnest, 1 - glm::length(inside) / glm::length(outside));
  }
  CHECK(thinnest > 0.02);
}

TEST_CASE("normals have unit length and point out of the ice", "[procedural]") {
  const Mesh mesh = make_ice(hollow_block());
  REQUIRE(mesh.normals.size() == mesh.positions.size());
  std::size_t wrong = 0;
  for (const auto& t : mesh.triangles) {
    const dvec3 a(mesh.positions[t.x]), b(mesh.positions[t.y]), c(mesh.positions[t.z]);
    const dvec3 ng = glm::normalize(glm::cross(b - a, c - a));
    for (const unsigned corner : {t.x, t.y, t.z}) {
      const dvec3 ns(mesh.normals[corner]);
      wrong += std::abs(glm::length(ns) - 1) > 1e-6 || glm::dot(ns, ng) < 0.2;
    }
  }
  CHECK(wrong == 0);
}

TEST_CASE("the liquid fills the cavity up to its level and stays in the ice", "[procedural]") {
  for (const double share : {0.15, 0.5, 0.62, 0.9}) {
    const IceBlock block = hollow_block(7, 24);
    IceBlock solid = block;
    solid.hollow = false;
    const glm::dvec2 range = cavity_levels(block);
    const double level = range.x + share * (range.y - range.x);
    const Mesh ice = make_ice(block), full = make_ice(solid), liquid = make_ice_liquid(block, level);
    procedural::Sequence random(99);
    int below = 0, above = 0;
    for (int i = 0; i < 400; i++) {
      const dvec3 p{random.between(-1, 1), random.between(-1, 1), random.between(-1, 1)};
      const bool in_cavity = contains(full, p) && !contains(ice, p), in_liquid = contains(liquid, p);
      if (in_cavity) CHECK(in_liquid == (p.y < level));
      if (!contains(full, p)) CHECK_FALSE(in_liquid);
      if (p.y > level) CHECK_FALSE(in_liquid);
      below += in_cavity && p.y < level;
      above += in_cavity && p.y > level;
    }
    CHECK(below > 0);
    CHECK(above > 0);
  }
}

TEST_CASE("what cannot be generated says what to change", "[procedural]") {
  IceBlock thin = hollow_block();
  thin.cavity.size = thin.outer.size;
  CHECK_THROWS_AS(make_ice(thin), GenerateError);
  IceBlock off = hollow_block();
  off.cavity.offset = {5, 0, 0};
  CHECK_THROWS_AS(make_ice(off), GenerateError);
  CHECK_THROWS_AS(make_ice_liquid(hollow_block(), 3), GenerateError);
  IceBlock solid = hollow_block();
  solid.hollow = false;
  CHECK_THROWS_AS(make_ice_liquid(solid, 0), GenerateError);
}

TEST_CASE("gradient noise is smooth, bounded and not constant", "[procedural]") {
  double least = 1, greatest = -1, steepest = 0;
  for (int i = 0; i < 2000; i++) {
    const dvec3 p{0.037 * i, -0.011 * i, 0.5 + 0.003 * i};
    const double here = procedural::gradient_noise(5, p),
                 near = procedural::gradient_noise(5, p + dvec3{1e-4, 0, 0});
    least = std::min(least, here);
    greatest = std::max(greatest, here);
    steepest = std::max(steepest, std::abs(near - here) / 1e-4);
  }
  CHECK(least < -0.2);
  CHECK(greatest > 0.2);
  CHECK(least >= -1);
  CHECK(greatest <= 1);
  CHECK(steepest < 6);
}
