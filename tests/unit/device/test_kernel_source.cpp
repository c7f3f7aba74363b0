// Kernel files become one text: includes once each, lines named.
#include <fmt/format.h>

#include <algorithm>

#include "base/file.h"
#include "catch.h"
#include "device/embedded_kernels.h"
#include "device/kernel_source.h"
#include "occurrences.h"
#include "temporary_folder.h"

using namespace sundog;

TEST_CASE("a program is known by its plain text, without a translation") {
  GeneratedFiles files = {{"main.cl", "#include \"plain/one.cl\"\n"},
                          {"plain/one.cl", "ENTRY static float half_of(float x) { return 0.5f * x; }\n"}};
  const auto identity = [&] { return KernelText{"main.cl", {}, files}.identity(); };
  const std::string before = identity();
  CHECK(before.find("static float half_of(float x)") != std::string::npos);
  CHECK(KernelText{"main.cl", {}, files}.expanded().find("REAL half_of(") != std::string::npos);
  CHECK(before == identity());
  CHECK(before != KernelText{"main.cl", {{"LANES", "4"}}, files}.identity());
  files["plain/one.cl"] += "// changed\n";
  CHECK(before != identity());
}

TEST_CASE(
    "what several plain files use is in a program once, and again behind an #if that may leave it out") {
  const std::string use =
      "#include \"plain/half.h\"\nENTRY static float {}(float x) {{ return half_of(x); }}\n";
  GeneratedFiles files = {{"plain/half.h", "static float half_of(float x) { return 0.5f * x; }\n"},
                          {"plain/one.cl", fmt::format(fmt::runtime(use), "one_of")},
                          {"plain/two.cl", fmt::format(fmt::runtime(use), "two_of")},
                          {"main.cl", "#include \"plain/one.cl\"\n#include \"plain/two.cl\"\n"}};
  const auto halves = [&] {
    return occurrences(KernelText{"main.cl", {}, files}.expanded(), "#define MADE_half_of\n");
  };
  CHECK(halves() == 1);
  files["main.cl"] = "#if X\n#include \"plain/one.cl\"\n#endif\n#include \"plain/two.cl\"\n";
  CHECK(halves() == 2);
}

TEST_CASE("the embedded kernels are the files of kernels/, byte for byte") {
  namespace fs = std::filesystem;
  std::size_t files = 0;
  const fs::path folder = fs::path(SUNDOG_SOURCE_DIR) / "kernels";
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    if (entry.path().extension() != ".h" && entry.path().extension() != ".cl") continue;
    ++files;
    CHECK(embedded_kernel(fs::relative(entry.path(), folder).string()) == read_file(entry.path()));
  }
  CHECK(files == embedded_kernels().size());
  CHECK(files > 0);
}

TEST_CASE("a folder replaces the embedded kernels") {
  const TemporaryFolder folder;
  std::filesystem::create_directories(folder.path() / "lib");
  write_file(folder.path() / "lib" / "own.cl", "int own;\n");
  CHECK(embedded_kernel("lib/own.cl", folder.path()) == "int own;\n");
  CHECK_THROWS_AS(embedded_kernel("shared/types.h", folder.path()), MissingKernelFile);
  CHECK(KernelText{"lib/own.cl", {}, {}, folder.path()}.expanded().find("int own;") != std::string::npos);
}

TEST_CASE("a file included twice is expanded once, and #line names what follows") {
  const GeneratedFiles files = {{"main.cl", "#include \"a.cl\"\n#include \"b.cl\"\nint in_main;\n"},
                                {"a.cl", "#include \"b.cl\"\nint in_a;\n"},
                                {"b.cl", "int in_b;"}};
  const std::string text = KernelText{"main.cl", {}, files}.expanded();
  CHECK(occurrences(text, "int in_b;") == 1);
  CHECK(text.find("int in_b;") < text.find("int in_a;"));
  CHECK(text.find("#line 1 \"b.cl\"\nint in_b;\n") != std::string::npos);
  CHECK(text.find("#line 2 \"a.cl\"\nint in_a;\n") != std::string::npos);
  CHECK(text.find("#line 2 \"main.cl\"\n\nint in_main;\n") != std::string::npos);
}

TEST_CASE("a file included under an #if is there again for those who need it for certain") {
  const GeneratedFiles files = {{"main.cl", "#if WANTED\n#include \"a.cl\"\n#endif\n#include \"a.cl\"\n"},
                                {"a.cl", "int in_a;\n"}};
  const std::string text = KernelText{"main.cl", {}, files}.expanded();
  CHECK(occurrences(text, "int in_a;") == 2);
  CHECK(occurrences(text, "#ifndef SUNDOG_INCLUDED_a_cl\n#define SUNDOG_INCLUDED_a_cl\n") == 2);
}

TEST_CASE(
    "a file seen in a branch of an #if is there again in no text of that branch, but in other branches") {
  const GeneratedFiles files = {{"main.cl",
                                 "#if A\n#include \"b.cl\"\n#include \"c.cl\"\n#if B\n#include "
                                 "\"c.cl\"\n#endif\n#else\n#include \"c.cl\"\n#endif\n"},
                                {"b.cl", "#if C\n#include \"d.cl\"\n#endif\n#include \"c.cl\"\n"},
                                {"c.cl", "int in_c;\n"},
                                {"d.cl", "#include \"c.cl\"\n"}};
  // Under C, behind that, and under #else.
  CHECK(occurrences(KernelText{"main.cl", {}, files}.expanded(), "int in_c;") == 3);
}

TEST_CASE("#pragma once is left out: the expanded text is one file") {
  const GeneratedFiles files = {{"main.cl", "// Comment.\n#pragma once\n#pragma unroll 1\nint x;\n"}};
  const std::string text = KernelText{"main.cl", {}, files}.expanded();
  CHECK(occurrences(text, "once") == 0);
  CHECK(occurrences(text, "// Comment.\n\n#pragma unroll 1\nint x;\n") == 1);
}

TEST_CASE("defines stand first, sorted by name") {
  const GeneratedFiles files = {{"main.cl", "int x;\n"}};
  const std::string text = KernelText{"main.cl", {{"ZETA", "1"}, {"ALPHA", "2.0f"}}, files}.expanded();
  CHECK(text.find("#define ALPHA 2.0f\n#define ZETA 1\n") < text.find("int x;"));
}

TEST_CASE("generated files go before embedded ones of the same path; <angle> includes are left alone") {
  const GeneratedFiles files = {{"main.cl", "#include \"shared/types.h\"\n#include <cstdint>\n"},
                                {"shared/types.h", "int own_types;\n"}};
  const std::string text = KernelText{"main.cl", {}, files}.expanded();
  CHECK(occurrences(text, "int own_types;") == 1);
  CHECK(occurrences(text, "#include <cstdint>") == 1);
}

TEST_CASE("a missing or circular include names the file and line that asks for it") {
  const GeneratedFiles files = {{"main.cl", "int x;\n#include \"lib/nowhere.cl\"\n"},
                                {"self.cl", "#include \"other.cl\"\n"},
                                {"other.cl", "\n\n#include \"self.cl\"\n"}};
  CHECK_THROWS_WITH((KernelText{"main.cl", {}, files}.expanded()),
                    "main.cl:2: lib/nowhere.cl: there is no such kernel file");
  CHECK_THROWS_WITH((KernelText{"self.cl", {}, files}.expanded()), "other.cl:3: self.cl includes itself");
  CHECK_THROWS_AS((KernelText{"absent.cl", {}, files}.expanded()), BuildError);
}
