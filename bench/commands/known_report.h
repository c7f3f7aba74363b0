// Reports that an earlier run of a bench wrote, read again.
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

/// Throws SceneError where the file is no report of a bench.
KnownReport read_report(const std::string& file);

/// A cell of a row, by the name that the JSON has for the column; empty: there is none.
std::string known_cell(const Table& table, const std::vector<Cell>& row, const std::string& column);

/// Throws UsageError where `known` has rows that are as the last one of `rows` in the columns `keys`, the
/// first of which names it, but none equal to it.
void check_known(const Table& known, const Table& rows, const std::vector<std::string>& keys,
                 const std::string& file);

}  // namespace sundog
