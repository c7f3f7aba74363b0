// render --tiles and merge: a frame from parts that were rendered apart.
#include <base/file.h>

#include <fstream>

#include "catch.h"
#include "cli_scene.h"
#include "render/film/part.h"

using namespace sundog;

namespace {

struct PartsFolder : CliFolder {
  CommandResult part(const std::string& which, const std::string& name,
                     const std::vector<std::string>& more = {}) const {
    std::vector<std::string> all = {"render", scene,   "-o",        file(name), "--tiles", which,
                                    "--size", "50x70", "--samples", "2",        "--quiet"};
    all.insert(all.end(), more.begin(), more.end());
    return run_sundog(all);
  }
  CommandResult merge(const std::vector<std::string>& names, const std::string& out = "merged.pfm") const {
    std::vector<std::string> all = {"merge", "-o", file(out)};
    for (const std::string& name : names) all.push_back(file(name));
    return run_sundog(all);
  }
  std::string whole(const std::string& out = "whole.pfm", const std::vector<std::string>& more = {}) const {
    std::vector<std::string> all = {"render", scene, "-o", file(out), "--size", "50x70", "--samples", "2"};
    all.insert(all.end(), more.begin(), more.end());
    REQUIRE(run_sundog(all).status == 0);
    return read_file(*this / out);
  }
};

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

}  // namespace

TEST_CASE("parts rendered apart give the image of the whole, in any order") {
  const PartsFolder folder;
  for (const char* which : {"1/3", "2/3", "3/3"})
    REQUIRE(folder.part(which, std::string(1, which[0]) + ".part").status == 0);
  const CommandResult result = folder.merge({"3.part", "1.part", "2.part"});
  CAPTURE(result.err);
  CHECK(result.status == 0);
  CHECK(read_file(folder / "merged.pfm") == folder.whole());
  REQUIRE(folder.part("1/1", "all.part").status == 0);
  CHECK(folder.merge({"all.part"}).status == 0);
  CHECK(read_file(folder / "merged.pfm") == folder.whole());
  CHECK(std::filesystem::file_size(folder / "1.part") < std::filesystem::file_size(folder / "all.part") / 2);
}

TEST_CASE("parts carry the AOVs") {
  const PartsFolder folder;
  const std::vector<std::string> aovs = {"--aov", "depth", "--aov", "albedo"};
  REQUIRE(folder.part("1/2", "1.part", aovs).status == 0);
  REQUIRE(folder.part("2/2", "2.part", aovs).status == 0);
  REQUIRE(folder.merge({"1.part", "2.part"}, "merged.exr").status == 0);
  CHECK(read_file(folder / "merged.exr") == folder.whole("whole.exr", aovs));
  CHECK(folder.merge({"1.part", "2.part"}, "merged.png").status == 2);  // which cannot hold them
}

TEST_CASE("parts that do not make one frame are refused, with status 3 and the reason") {
  const PartsFolder folder;
  REQUIRE(folder.part("1/2", "1.part").status == 0);
  REQUIRE(folder.part("2/2", "2.part").status == 0);
  REQUIRE(folder.part("2/2", "again.part").status == 0);
  REQUIRE(folder.part("2/2", "samples.part", {"--set", "/render/samples=3"}).status == 0);
  REQUIRE(folder.part("2/2", "camera.part", {"--set", "/camera/fov=41"}).status == 0);
  REQUIRE(folder.part("2/2", "size.part", {"--set", "/image/height=72"}).status == 0);
  REQUIRE(folder.part("2/2", "aov.part", {"--aov", "depth"}).status == 0);
  REQUIRE(folder.part("2/3", "third.part").status == 0);
  std::filesystem::copy_file(folder / "2.part", folder / "short.part");
  std::filesystem::resize_file(folder / "short.part", std::filesystem::file_size(folder / "short.part") - 9);
  folder.write("image.part", "P6 no part");
  struct Case {
    std::vector<std::string> parts;
    const char* says;
  };
  for (const Case& c :
       {Case{{"1.part"}, "part 2 of 2 is missing: render it as part 2/2 and with the"},
        Case{{"third.part"}, "parts 1, 3 of 3 are missing: render each as part I/3 and with the"},
        Case{{"1.part", "none.part"}, "none.part: cannot be read: No such file or directory"},
        Case{{"1.part", "2.part", "again.part"}, "is part 2 of 2, and so is "},
        Case{{"1.part", "samples.part"}, "it is rendered with samples 3, the other samples 2"},
        Case{{"1.part", "camera.part"}, "--set /camera/fov 41, the other no --set /camera/fov"},
        Case{{"1.part", "size.part"}, "it is 50x72 pixels, the other 50x70"},
        Case{{"1.part", "aov.part"}, "AOVs [depth], the other []"},
        Case{{"1.part", "third.part"}, "one of 3 parts, the other one of 2"},
        Case{{"1.part", "short.part"}, "is damaged: render this part again"},
        Case{{"image.part"}, "is no part of a frame"}}) {
    const CommandResult result = folder.merge(c.parts);
    CAPTURE(c.says, result.err);
    CHECK(result.status == 3);
    CHECK(is_one_error_line(result.err));
    CHECK(contains(result.err, c.says));
    CHECK_FALSE(std::filesystem::exists(folder / "merged.pfm"));
  }
}

TEST_CASE("a part for which the disk has no room is kept elsewhere, with status 1") {
  const PartsFolder folder;
  REQUIRE(folder.part("1/1", "good.part").status == 0);
  const std::string good = read_file(folder / "good.part");
  std::filesystem::create_directory(folder / "tmp");
  CommandOptions options;
  options.environment = {{"TMPDIR", folder.file("tmp")}, {"SUNDOG_FAULTS", "write@1.part"}};
  std::vector<std::string> command = {"render",    folder.scene, "-o",     folder.file("1.part"),
                                      "--tiles",   "1/1",        "--size", "50x70",
                                      "--samples", "2",          "--quiet"};
  CommandResult result = run_sundog(command, options);
  CAPTURE(result.err);
  CHECK(result.status == 1);
  CHECK(is_one_error_line(result.err));
  CHECK(contains(result.err, "No space left on device; the part is in " + folder.file("tmp") + "/"));
  for (const auto& file : std::filesystem::recursive_directory_iterator(folder / "tmp"))
    if (file.is_regular_file()) CHECK(read_file(file.path()) == good);
  CHECK_FALSE(std::filesystem::is_empty(folder / "tmp"));
  command.insert(command.end(), {"--resume", folder.file("c")});
  result = run_sundog(command, options);
  CHECK(result.status == 1);
  CHECK(contains(result.err, "all of it is in " + folder.file("c")));
  options.environment["SUNDOG_FAULTS"] = "build@0:0,build@0:1";  // nothing is drawn again
  CHECK(run_sundog(command, options).status == 0);
  CHECK(read_file(folder / "1.part") == good);
  CHECK_FALSE(std::filesystem::exists(folder / "c"));
}

TEST_CASE("--tiles wants a part that there is, and a file for it") {
  const PartsFolder folder;
  for (const std::string which : {"0/2", "3/2", "1", "1/", "/2", "1/0", "a/b"}) {
    const CommandResult result = folder.part(which, "1.part");
    CHECK(result.status == 2);
    CHECK(contains(result.err, "--tiles " + which));
  }
  CHECK(contains(folder.part("1/100000", "1.part").err, "N parts from 1 to 65536"));
  CHECK(folder.part("1/2", "1.png").status == 2);
  CHECK(run_sundog({"merge", "-o", folder.file("a.png")}).status == 2);
  CHECK(folder.entries() == 1);
}

TEST_CASE("the rows of all parts are the frame's, each once") {
  for (const int height : {1, 4, 30, 480, 1081})
    for (const int count : {1, 2, 7, 600}) {
      std::vector<int> covered(static_cast<std::size_t>(height));
      for (int index = 1; index <= count; ++index)
        for (const RowRange& rows : part_rows(height, {index, count}))
          for (int y = rows.first; y < rows.first + rows.count; ++y)
            covered.at(static_cast<std::size_t>(y)) += 1;
      CHECK(covered == std::vector<int>(covered.size(), 1));
    }
}
