// Calls memfd_create(), and fills the file by pwrite().
#include "base/memory_file.h"

#include <sys/mman.h>
#include <unistd.h>

#include <cerrno>

namespace sundog {

int memory_file(const std::string& text) {
  const int file = ::memfd_create("sundog", MFD_CLOEXEC);
  std::size_t written = 0;
  while (file >= 0 && written < text.size()) {
    const ssize_t part =
        ::pwrite(file, text.data() + written, text.size() - written, static_cast<off_t>(written));
    if (part > 0) {
      written += static_cast<std::size_t>(part);
    } else if (part == 0 || errno != EINTR) {
      ::close(file);
      return -1;
    }
  }
  return file;
}

}  // namespace sundog
