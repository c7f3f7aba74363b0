// The exception that the library throws.
#pragma once
#include <sundog/version.h>

#include <stdexcept>
#include <string>

namespace sundog {
inline namespace v0 {

/// The category of an error.
enum class ErrorKind {
  usage,    ///< an argument is invalid or contradicts another
  scene,    ///< the scene or a file that it names is invalid: Error::file(), Error::place()
  device,   ///< no such device, or every device failed: Error::status()
  build,    ///< a kernel does not build: Error::log()
  io,       ///< a file cannot be read or written
  internal  ///< anything else, such as lack of memory
};

/// Details of an Error besides its message; each may be empty.
struct ErrorFacts {
  std::string file{};    ///< the file at fault
  std::string place{};   ///< in that file: a JSON pointer, "line 12" or "byte 80"
  std::string reason{};  ///< the message without file and place
  std::string log{};     ///< an OpenCL compiler's messages
  int status = 0;        ///< OpenCL's error code; 0: none
};

/// The only exception type of the library. what() is one line: the place, what was expected, what was found.
/// Exceptions of the caller's callbacks pass through render() unchanged. Immutable except by assignment.
class SUNDOG_API Error : public std::runtime_error {
 public:
  /// `what` is the message; `facts` are its details.
  Error(ErrorKind kind, const std::string& what, ErrorFacts facts = {});
  Error(const Error&);             ///< copies the error
  Error& operator=(const Error&);  ///< copies the error
  ~Error() override;

  /// The category of the error.
  ErrorKind kind() const noexcept { return kind_; }
  /// The file at fault; empty if none.
  const std::string& file() const noexcept { return facts_.file; }
  /// The place in file(): a JSON pointer, "line 12" or "byte 80"; empty if none.
  const std::string& place() const noexcept { return facts_.place; }
  /// what() without file and place.
  const std::string& reason() const noexcept { return facts_.reason; }
  /// OpenCL's error code; 0 if none.
  int status() const noexcept { return facts_.status; }
  /// The OpenCL compiler's messages, with file and line; empty if none.
  const std::string& log() const noexcept { return facts_.log; }

 private:
  ErrorKind kind_;
  ErrorFacts facts_;
};

}  // namespace v0
}  // namespace sundog
