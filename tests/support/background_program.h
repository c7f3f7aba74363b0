// A program that runs beside a test, which reads its output line by line and ends it.
#pragma once
#include <filesystem>
#include <map>
#include <string>
#include <vector>

class BackgroundProgram {
 public:
  /// Starts the program in `folder`; its stderr is the test's own. `environment` is added to the test's.
  BackgroundProgram(const std::vector<std::string>& arguments, const std::filesystem::path& folder = {},
                    const std::map<std::string, std::string>& environment = {});
  /// Ends the program by SIGTERM, after five seconds by SIGKILL.
  ~BackgroundProgram();
  BackgroundProgram(const BackgroundProgram&) = delete;
  BackgroundProgram& operator=(const BackgroundProgram&) = delete;

  /// The next line of its output that contains `part`. Throws std::runtime_error if the program ends or
  /// `seconds` pass without one.
  std::string line_with(const std::string& part, double seconds = 30);
  bool runs() const;
  void end();

 private:
  int out_ = -1;
  int child_ = -1;
  std::string text_;
};
