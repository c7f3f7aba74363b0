// The standard streams where a command names a file: "-".
#pragma once
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

namespace sundog {

class Faults;

/// A standard stream that is closed becomes /dev/null, before a file of a driver takes its number and with it
/// what is printed.
void open_standard_streams();

/// Throws IoError where what was printed so far cannot be written.
void flush_standard_output();

bool is_standard_stream(const std::filesystem::path& path);

/// The text of the standard input: it is read once, and kept. Throws UsageError where it is a terminal,
/// IoError.
const std::string& standard_input();

/// For a process whose input is elsewhere: the text that it stands for.
void set_standard_input(std::string text);

/// From now on all that is printed to stdout goes to stderr, and write_output() alone writes to what stdout
/// was. A reader that leaves early makes write_output() fail, and no more ends the process.
void claim_standard_output();

/// write_file(); "-" is the claimed standard output. Throws IoError.
void write_output(const std::filesystem::path& path, std::string_view bytes,
                  const std::shared_ptr<Faults>& faults = nullptr);

}  // namespace sundog
