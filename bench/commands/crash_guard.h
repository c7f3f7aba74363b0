// Measures in a child process, so that a driver's crash costs one row: another child measures the rest.
#pragma once
#include <filesystem>
#include <functional>
#include <string>

namespace sundog {

/// Runs `measure` in a child process of this program with the same command line, and in another one after
/// each row that crashes it; with `reads_input`, each child gets the whole standard input. Returns the last
/// child's exit status. Throws DeviceError if a child crashes outside of all rows or twice in one. Measures
/// in this process if no temporary folder can be made.
int guarded(const std::function<int()>& measure, bool reads_input);

/// Tells the parent that the child enters the row; "": leaves it. Returns how an earlier child crashed in the
/// row, "" if none did.
std::string enter_row(std::string name);

/// The file that keeps the measured rows for the next child; empty if this process is not a child.
std::filesystem::path kept_for_next();

}  // namespace sundog
