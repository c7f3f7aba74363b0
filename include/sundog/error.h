// What functions of the library throw.
#pragma once
#include <sundog/version.h>

#include <stdexcept>
#include <string>

namespace sundog {
inline namespace v0 {

/// Whose fault it is.
enum class ErrorKind {
  usage,    ///< an argument is wrong, or does not fit the others
  scene,    ///< the scene, or a file that it names, is bad: Error::file(), Error::place()
  device,   ///< no such device, or every device failed: Error::status()
  build,    ///< a kernel does not build: Error::log()
  io,       ///< a file cannot be read or written
  internal  ///< all others, such as a want of memory
};

/// What an Error knows beside its line; each may be empty.
struct ErrorFacts {
  std::string file{};    ///< the file at fault
  std::string place{};   ///< in that file: a JSON pointer, "line 12" or "byte 80"
  std::string reason{};  ///< the line without file and place
  std::string log{};     ///< an OpenCL compiler's messages
  int status = 0;        ///< OpenCL's error code; 0: none
};

/// The only exception of the library's own. what() is one line: the place, what was wanted, what was found.
/// Exceptions of a program's callbacks pass through render() as they are. Immutable, but for assignment.
class SUNDOG_API Error : public std::runtime_error {
 public:
  /// `what` is the line; `facts` what is known beside it.
  Error(ErrorKind kind, const std::string& what, ErrorFacts facts = {});
  Error(const Error&);             ///< the same error
  Error& operator=(const Error&);  ///< the same error
  ~Error() override;

  /// Whose fault it is.
  ErrorKind kind() const noexcept { return kind_; }
  /// The file at fault; empty where none is.
  const std::string& file() const noexcept { return facts_.file; }
  /// In that file: a JSON pointer, "line 12" or "byte 80"; empty where there is none.
  const std::string& place() const noexcept { return facts_.place; }
  /// what() without file and place.
  const std::string& reason() const noexcept { return facts_.reason; }
  /// OpenCL's error code; 0 where there is none.
  int status() const noexcept { return facts_.status; }
  /// The OpenCL compiler's messages, with file and line; empty where there are none.
  const std::string& log() const noexcept { return facts_.log; }

 private:
  ErrorKind kind_;
  ErrorFacts facts_;
};

}  // namespace v0
}  // namespace sundog
