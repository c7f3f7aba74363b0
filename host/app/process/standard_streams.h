// Reads the standard input and writes the standard output where a command names a file "-".
#pragma once
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

namespace sundog {

class Faults;

/// Opens /dev/null for each standard stream that is closed, before a driver's file takes its number and
/// receives what is printed.
void open_standard_streams();

/// Throws UsageError if the standard output is closed.
void require_standard_output();

/// Throws IoError if anything printed so far could not be written.
void flush_standard_output();

bool is_standard_stream(const std::filesystem::path& path);

/// The text of the standard input, which is read once and kept. Throws UsageError if it is a terminal,
/// IoError.
const std::string& standard_input();

/// Sets the text that standard_input() returns, for a worker whose parent has read it.
void set_standard_input(std::string text);

/// From now on, all text printed to stdout goes to stderr, and only write_output() writes to the original
/// stdout. A reader that leaves early makes write_output() fail instead of ending the process.
void claim_standard_output();

/// write_file(); "-" is the claimed standard output. Throws IoError.
void write_output(const std::filesystem::path& path, std::string_view bytes,
                  const std::shared_ptr<Faults>& faults = nullptr);

}  // namespace sundog
