// What `sundog` does for each of its commands. Each returns the exit status; errors are exceptions.
#pragma once
#include "app/options/options.h"
#include "app/process/exit_status.h"

namespace sundog {

int render_command(const RenderCommand& command);
int info_command(const InfoCommand& command);
/// `argv` as main() has it.
int worker_command(int argc, const char* const* argv);
int compile_command(int argc, const char* const* argv);
int merge_command(const MergeCommand& command);
int compare_command(const CompareCommand& command);

}  // namespace sundog
