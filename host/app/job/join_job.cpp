// Connects a process to the others that mpirun started: reads the launcher's variables, and loads MPI through
// a shared library that nothing else in sundog needs.
#include <dlfcn.h>
#include <fmt/format.h>
#include <sched.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>

#include "app/job/job.h"
#include "app/process/environment.h"
#include "app/process/spawn_self.h"
#include "base/error.h"
#include "base/file.h"

namespace sundog {
namespace {

namespace fs = std::filesystem;

constexpr const char* library = "sundog_mpi.so";

/// The variable's number; -1 if not set.
int number_of(const char* variable) {
  const char* text = std::getenv(variable);
  return text && *text ? std::atoi(text) : -1;
}

/// The first variable that is set. Open MPI's come first; PMI and PMIx are for other launchers such as Slurm.
int first_number(std::initializer_list<const char*> variables) {
  for (const char* variable : variables)
    if (const int number = number_of(variable); number >= 0) return number;
  return -1;
}

/// The number of processes; -1: unknown.
int job_size() { return first_number({"OMPI_COMM_WORLD_SIZE", "PMI_SIZE"}); }

/// Undoes Open MPI's default binding of each process to a core or socket, meant for single-threaded programs:
/// gives this process the launcher's cores. Keeps a binding that the user requested.
void undo_default_binding() {
  const bool bound = std::getenv("OMPI_MCA_orte_bound_at_launch") != nullptr;
  const bool asked_for = std::getenv("OMPI_MCA_hwloc_base_binding_policy") != nullptr;
  cpu_set_t launcher;
  CPU_ZERO(&launcher);
  if (bound && !asked_for && ::sched_getaffinity(::getppid(), sizeof launcher, &launcher) == 0)
    ::sched_setaffinity(0, sizeof launcher, &launcher);
}

/// The library beside the program, or in its installation folder; empty if missing.
fs::path find_library() {
  const fs::path folder = program_file().parent_path();
  for (const char* where : {"", SUNDOG_LIBRARY_FOLDER})
    if (const fs::path file = folder / where / library; is_there(file)) return file;
  return {};
}

OpenTransport* load_transport() {
  const fs::path file = find_library();
  const std::string instead =
      "; or make parts with --tiles I/N and join them with sundog merge, without mpirun";
  if (file.empty())
    throw UsageError(
        fmt::format("started by mpirun, but this sundog was built without MPI: install Open MPI (Debian: "
                    "libopenmpi-dev openmpi-bin) and build it again{}",
                    instead));
  // Open MPI's plugins look for its symbols among the global ones.
  void* loaded = ::dlopen(file.c_str(), RTLD_NOW | RTLD_GLOBAL);
  void* symbol = loaded ? ::dlsym(loaded, open_transport_name) : nullptr;
  if (!symbol)
    throw UsageError(fmt::format("{}: cannot be loaded: {}{}", file.string(), ::dlerror(), instead));
  return reinterpret_cast<OpenTransport*>(symbol);
}

}  // namespace

int job_rank() {
  return job_size() == 1 ? -1 : first_number({"OMPI_COMM_WORLD_RANK", "PMIX_RANK", "PMI_RANK"});
}

std::unique_ptr<Mailbox> join_job() {
  const int rank = job_rank();
  if (rank < 0) return nullptr;
  OpenTransport* open = load_transport();
  undo_default_binding();
  auto job = std::make_unique<Mailbox>([open] { return std::unique_ptr<Transport>(open()); },
                                       program_environment()->silence_limit);
  if (const int size = job_size(); size > 0 && size != job->size())
    throw UsageError(
        fmt::format("the launcher has started {} processes, of which Open MPI sees {}: start sundog by the "
                    "mpirun that belongs to {}",
                    size, job->size(), library));
  return job;
}

}  // namespace sundog
