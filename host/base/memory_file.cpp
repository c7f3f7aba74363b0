// Creates and fills a memory file with memfd_create().
#include "base/memory_file.h"

#include <sys/mman.h>
#include <unistd.h>

#include "base/file.h"

namespace sundog {

int memory_file(const std::string& text) {
  const int file = ::memfd_create("sundog", MFD_CLOEXEC);
  if (file < 0 || (write_all(file, text) && ::lseek(file, 0, SEEK_SET) == 0)) return file;
  ::close(file);
  return -1;
}

}  // namespace sundog
