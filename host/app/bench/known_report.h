// An earlier report of a bench, whose runs need not be taken again.
#pragma once
#include <map>
#include <string>

#include "bench/report/report.h"

namespace sundog {

struct KnownReport {
  Table devices, scenes;
  std::map<std::string, MeasuredWay> ways;  // by name, those without a problem
};

/// Throws IoError, UsageError where it is no report of `bench`, or one of another revision.
KnownReport read_known_report(const std::string& file, const std::string& bench, const std::string& revision);

/// Throws UsageError where `known` has rows named (by the column `name`) as the last one of `rows`, but none
/// equal to it.
void check_known(const Table& known, const Table& rows, const std::string& name, const std::string& file);

}  // namespace sundog
