// Measures in a process of its own, so that a driver that ends it costs one row: another process measures the
// rest.
#pragma once
#include <filesystem>
#include <functional>
#include <string>

namespace sundog {

/// Runs `measure` in another process of this program with the same command line, again for as long as rows of
/// the bench end it; with `reads_input` each has the standard input. Returns its exit status. Throws
/// DeviceError when it ends outside of all rows. Measures in this process where no temporary folder can be
/// made.
int guarded(const std::function<int()>& measure, bool reads_input);

/// For the process that measures. From here on it is at the row; "": at none. Returns why an earlier process
/// ended there, "" if none did.
std::string enter_row(std::string name);

/// Where the rows measured so far are kept for the next process; empty: nobody is there to start one.
std::filesystem::path kept_for_next();

}  // namespace sundog
