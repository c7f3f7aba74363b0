// The byte transport between the processes of a job. The MPI implementation is a separate shared library
// (host/mpi), loaded only by a sundog started by mpirun; tests use one within a process.
#pragma once
#include <optional>
#include <string>
#include <vector>

namespace sundog {

struct Parcel {
  int from = 0;
  std::string bytes;
};

/// Processes are numbered by rank, 0 to hosts().size() - 1. Use from the creating thread only.
class Transport {
 public:
  virtual ~Transport() = default;
  virtual int rank() const = 0;
  /// The host name of each rank.
  virtual const std::vector<std::string>& hosts() const = 0;
  /// Starts sending. Parcels between two ranks arrive in order; those to a dead rank are lost.
  virtual void post(int rank, std::string bytes) = 0;
  /// Returns a complete parcel, without waiting.
  virtual std::optional<Parcel> take() = 0;
  /// Ends in an orderly way: waits for all ranks.
  virtual void finish() = 0;
  /// Ends the other ranks by force, and this process with `status`.
  [[noreturn]] virtual void abort(int status) = 0;
};

/// The library's export under open_transport_name: opens the transport in the calling thread.
using OpenTransport = Transport*();
inline constexpr const char* open_transport_name = "sundog_open_transport";

}  // namespace sundog
