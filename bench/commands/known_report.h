// Reads the JSON report that an earlier run of a bench wrote.
#pragma once
#include <string>
#include <vector>

#include "bench/report/report.h"

namespace sundog {

struct KnownReport {
  std::string bench, revision;
  Table devices, scenes;
  std::vector<MeasuredWay> ways;
};

/// Throws SceneError if the file is not a bench's report, or one of another schema.
KnownReport read_report(const std::string& file);

/// The row's cell in the column with this name in the JSON; empty if there is no such column.
std::string known_cell(const Table& table, const std::vector<Cell>& row, const std::string& column);

/// Throws UsageError if `known` has rows that match the last of `rows` in the columns `keys`, but none that
/// equals it in all columns except the file. The message names the row by the first key.
void check_known(const Table& known, const Table& rows, const std::vector<std::string>& keys,
                 const std::string& file);

}  // namespace sundog
