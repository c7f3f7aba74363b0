// What carries bytes between the processes of one job. The MPI one is a shared library of its own
// (host/mpi), which only a sundog that mpirun has started loads; tests have one within a process.
#pragma once
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace sundog {

struct Parcel {
  int from = 0;
  std::string bytes;
};

/// Processes are numbered by rank, 0 to hosts().size() - 1. Every call, and what made it, is one thread's.
class Transport {
 public:
  virtual ~Transport() = default;
  virtual int rank() const = 0;
  /// The name of each rank's machine.
  virtual const std::vector<std::string>& hosts() const = 0;
  /// Begins to send. Parcels of one rank to another arrive in order; one to a rank that is gone is lost.
  virtual void post(int rank, std::string bytes) = 0;
  /// What has arrived whole. Does not wait.
  virtual std::optional<Parcel> take() = 0;
  /// The end in good order: waits for all ranks to reach it.
  virtual void finish() = 0;
  /// The end when others do not reach it: ends them too, and this process with that status.
  [[noreturn]] virtual void abort(int status) = 0;
};

/// What the library exports under open_transport_name: begins, in the calling thread.
using OpenTransport = Transport*();
inline constexpr const char* open_transport_name = "sundog_open_transport";

}  // namespace sundog
