// The Transport over MPI: point-to-point messages of bytes, none of which is waited for, so that one thread
// can look after all ranks and a rank that has stopped holds nobody up. A shared library of its own, so that
// sundog starts without MPI, and where there is none.
#include <mpi.h>

#include <array>
#include <cstdlib>
#include <list>
#include <map>

#include "render/remote/transport.h"

namespace sundog {
namespace {

constexpr int tag = 0;

class MpiTransport : public Transport {
 public:
  MpiTransport() {
    int given = 0, size = 0;
    MPI_Init_thread(nullptr, nullptr, MPI_THREAD_FUNNELED, &given);
    MPI_Comm_rank(MPI_COMM_WORLD, &rank_);
    MPI_Comm_size(MPI_COMM_WORLD, &size);
    gather_hosts(size);
    // A rank that is gone shows as one that is silent; its errors must not end the others.
    MPI_Comm_set_errhandler(MPI_COMM_WORLD, MPI_ERRORS_RETURN);
  }

  int rank() const override { return rank_; }
  const std::vector<std::string>& hosts() const override { return hosts_; }

  void post(int rank, std::string bytes) override {
    Transfer& sent = sending_.emplace_back();
    sent.bytes = std::move(bytes);
    if (MPI_Isend(sent.bytes.data(), static_cast<int>(sent.bytes.size()), MPI_BYTE, rank, tag, MPI_COMM_WORLD,
                  &sent.request) != MPI_SUCCESS)
      sending_.pop_back();
  }

  std::optional<Parcel> take() override {
    sending_.remove_if([](Transfer& sent) { return is_done(sent.request); });
    begin_receiving();
    for (auto next = receiving_.begin(); next != receiving_.end(); ++next) {
      if (!is_done(next->second.request)) continue;
      Parcel parcel{next->first, std::move(next->second.bytes)};
      receiving_.erase(next);
      return parcel;
    }
    return std::nullopt;
  }

  void finish() override {
    while (!sending_.empty()) sending_.remove_if([](Transfer& sent) { return is_done(sent.request); });
    MPI_Finalize();
  }

  [[noreturn]] void abort(int status) override {
    MPI_Abort(MPI_COMM_WORLD, status);
    std::_Exit(status);
  }

 private:
  struct Transfer {
    std::string bytes;
    MPI_Request request = MPI_REQUEST_NULL;
  };

  static bool is_done(MPI_Request& request) {
    int done = 0;
    return MPI_Test(&request, &done, MPI_STATUS_IGNORE) != MPI_SUCCESS || done != 0;
  }

  void gather_hosts(int size) {
    using Name = std::array<char, MPI_MAX_PROCESSOR_NAME>;
    Name mine{};
    int length = 0;
    MPI_Get_processor_name(mine.data(), &length);
    std::vector<Name> all(static_cast<std::size_t>(size));
    MPI_Allgather(mine.data(), MPI_MAX_PROCESSOR_NAME, MPI_CHAR, all.data(), MPI_MAX_PROCESSOR_NAME, MPI_CHAR,
                  MPI_COMM_WORLD);
    for (const Name& name : all) hosts_.emplace_back(name.data());
  }

  /// One message of each rank at a time: the next of a rank is begun when the last has arrived.
  void begin_receiving() {
    for (int rank = 0; rank < static_cast<int>(hosts_.size()); ++rank) {
      if (rank == rank_ || receiving_.count(rank) > 0) continue;
      int found = 0, size = 0;
      MPI_Message message = MPI_MESSAGE_NULL;
      MPI_Status status;
      if (MPI_Improbe(rank, tag, MPI_COMM_WORLD, &found, &message, &status) != MPI_SUCCESS || found == 0)
        continue;
      MPI_Get_count(&status, MPI_BYTE, &size);
      Transfer& arriving = receiving_[rank];
      arriving.bytes.resize(static_cast<std::size_t>(size));
      MPI_Imrecv(arriving.bytes.data(), size, MPI_BYTE, &message, &arriving.request);
    }
  }

  int rank_ = 0;
  std::vector<std::string> hosts_;
  std::list<Transfer> sending_;
  std::map<int, Transfer> receiving_;
};

}  // namespace
}  // namespace sundog

extern "C" [[gnu::visibility("default")]] sundog::Transport* sundog_open_transport() {
  return new sundog::MpiTransport;
}
