// Several processes of one job where this sundog has no MPI.
#include <filesystem>

#include "catch.h"
#include "cli_scene.h"

TEST_CASE("started by mpirun without MPI, one process says what to do, and none writes") {
  const CliFolder folder;
  const std::string alone = folder.file("sundog");  // without the library beside it
  std::filesystem::copy_file(SUNDOG_BINARY, alone);
  CommandOptions options;
  options.environment = {{"OMPI_COMM_WORLD_SIZE", "2"}, {"OMPI_COMM_WORLD_RANK", "0"}};
  const std::vector<std::string> render = {alone, "render", folder.scene, "-o", folder.file("a.png")};
  const CommandResult first = run_command(render, options);
  CHECK(first.status == 2);
  CHECK(is_one_error_line(first.err));
  CHECK(first.err.find("libopenmpi-dev") != std::string::npos);
  CHECK(first.err.find("--tiles") != std::string::npos);
  options.environment.insert_or_assign("OMPI_COMM_WORLD_RANK", std::string(1, '1'));
  const CommandResult second = run_command(render, options);
  CHECK(second.status == 2);
  CHECK(second.err.empty());
  CHECK_FALSE(std::filesystem::exists(folder / "a.png"));
  options.environment = {{"OMPI_COMM_WORLD_SIZE", "1"}, {"OMPI_COMM_WORLD_RANK", "0"}};
  CHECK(run_command(render, options).status == 0);  // one process needs none
}
