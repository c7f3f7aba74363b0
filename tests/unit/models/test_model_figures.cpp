// Real meshes against figures that others measured (FIGURES.md of the optional assets).
#include <fstream>
#include <sstream>

#include "assets.h"
#include "catch.h"
#include "models/model.h"

using namespace sundog;

namespace {

struct Figures {
  std::string file;
  std::size_t vertices = 0, triangles = 0, without_area = 0;
  dvec3 lower{0}, upper{0};
  double area = 0, volume = 0;
};

// The rows of the table: | file | vertices | triangles | min | max | area | volume | zero-area | ...
std::vector<Figures> read_figures(const std::filesystem::path& path) {
  std::vector<Figures> rows;
  std::ifstream in(path);
  for (std::string line; std::getline(in, line);) {
    if (line.rfind("| ", 0) != 0 || line.find('/') == line.npos) continue;
    std::vector<std::string> cells;
    std::istringstream split(line.substr(1));
    for (std::string cell; std::getline(split, cell, '|');) cells.push_back(cell);
    Figures row;
    std::istringstream(cells.at(0)) >> row.file;
    row.vertices = std::stoul(cells.at(1));
    row.triangles = std::stoul(cells.at(2));
    std::istringstream(cells.at(3)) >> row.lower.x >> row.lower.y >> row.lower.z;
    std::istringstream(cells.at(4)) >> row.upper.x >> row.upper.y >> row.upper.z;
    row.area = std::stod(cells.at(5));
    row.volume = std::stod(cells.at(6));
    row.without_area = std::stoul(cells.at(7));
    rows.push_back(row);
  }
  return rows;
}

Figures measure(const Model& model) {
  Figures sum;
  sum.lower = dvec3(1e300);
  sum.upper = dvec3(-1e300);
  for (const Mesh& mesh : model.meshes) {
    sum.vertices += mesh.source_vertex_count;
    sum.triangles += mesh.triangles.size();
    for (const glm::uvec3 t : mesh.triangles) {
      const dvec3 a = mesh.positions[t.x], b = mesh.positions[t.y], c = mesh.positions[t.z];
      const double area = glm::length(glm::cross(b - a, c - a)) / 2;
      sum.area += area;
      sum.without_area += area == 0;
      sum.volume += glm::dot(a, glm::cross(b, c)) / 6;
      for (const dvec3& p : {a, b, c}) {
        sum.lower = glm::min(sum.lower, p);
        sum.upper = glm::max(sum.upper, p);
      }
    }
  }
  return sum;
}

double longest_normal_error(const Mesh& mesh) {
  double worst = 0;
  for (const glm::vec3& n : mesh.normals) worst = std::max(worst, std::abs(glm::length(dvec3(n)) - 1));
  return worst;
}

}  // namespace

TEST_CASE("real meshes have the counts, bounds, area and volume that were measured independently",
          "[assets]") {
  if (assets_directory().empty()) return;
  const std::vector<Figures> rows = read_figures(assets_directory() / "FIGURES.md");
  REQUIRE(rows.size() >= 10);
  for (const Figures& row : rows) {
    INFO(row.file);
    const Model model = load_model(assets_directory() / row.file);
    const Figures found = measure(model);
    CHECK(found.vertices == row.vertices);
    CHECK(found.triangles == row.triangles);
    for (int axis = 0; axis < 3; ++axis) {
      CHECK(found.lower[axis] == Approx(row.lower[axis]).epsilon(1e-5).margin(1e-6));
      CHECK(found.upper[axis] == Approx(row.upper[axis]).epsilon(1e-5).margin(1e-6));
    }
    CHECK(found.area == Approx(row.area).epsilon(1e-5));
    CHECK(found.volume == Approx(row.volume).epsilon(1e-4));
    CHECK(found.without_area == row.without_area);
    for (const Mesh& mesh : model.meshes) {
      const bool flat = std::string_view(row.file).ends_with("skull.obj");  // "s off"
      CHECK(mesh.normals.size() == (flat ? 0 : mesh.positions.size()));
      CHECK(longest_normal_error(mesh) < 1e-5);
    }
  }
}
