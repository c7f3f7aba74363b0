// Creates kernels of a built program, and checks the host's argument types against the kernel's.
#include <cxxabi.h>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cstdlib>
#include <map>
#include <sstream>

#include "base/error.h"
#include "device/cl_status.h"
#include "device/program.h"

namespace sundog {
namespace {

/// Normalises the spelling of a type ("unsigned int" and "uint" become "u32").
std::string plain_type(std::string type) {
  static const auto& spellings =
      *new const std::map<std::string, std::string>{{"unsigned int", "u32"}, {"uint", "u32"}, {"int", "i32"}};
  const bool pointer = type.ends_with('*');
  if (type.starts_with("struct ")) type.erase(0, std::string_view("struct ").size());
  if (pointer) type.pop_back();
  while (type.ends_with(' ')) type.pop_back();
  if (const auto found = spellings.find(type); found != spellings.end()) type = found->second;
  return pointer ? type + "*" : type;
}

void check_arguments(const cl::Kernel& kernel, const std::string& name, const std::string& entry,
                     const std::vector<std::string>& host_types) {
  std::vector<std::string> kernel_types = argument_types(kernel);
  if (kernel_types.empty() || host_types.empty()) return;
  std::ranges::transform(kernel_types, kernel_types.begin(), plain_type);
  if (kernel_types == host_types) return;
  throw BuildError(fmt::format("{}: kernel {} takes ({}), the host passes ({})", entry, name,
                               fmt::join(kernel_types, ", "), fmt::join(host_types, ", ")),
                   "");
}

}  // namespace

std::string kernel_type_name(const std::type_info& type) {
  int status = 0;
  const std::unique_ptr<char, decltype(&std::free)> text(
      abi::__cxa_demangle(type.name(), nullptr, nullptr, &status), &std::free);
  std::string name = status == 0 ? text.get() : type.name();
  if (const std::size_t scope = name.rfind("::"); scope != std::string::npos) name.erase(0, scope + 2);
  return plain_type(name);
}

cl::Kernel Program::make_kernel(const std::string& name, const std::vector<std::string>& host_types) const {
  const std::string entry = record_ ? record_->entry() : "an empty program";
  cl_int status = CL_INVALID_PROGRAM;
  cl::Kernel kernel;
  if (record_) kernel = cl::Kernel(record_->program, name.c_str(), &status);
  if (status != CL_SUCCESS)
    throw BuildError(fmt::format("{} has no kernel {}: {}", entry, name, cl_status_name(status)), "");
  check_arguments(kernel, name, entry, host_types);
  return kernel;
}

std::vector<std::string> Program::kernel_names() const {
  std::vector<std::string> names;
  std::istringstream in(record_ ? record_->program.getInfo<CL_PROGRAM_KERNEL_NAMES>() : "");
  for (std::string name; std::getline(in, name, ';');) names.push_back(name.substr(0, name.find('\0')));
  return names;
}

std::vector<std::string> argument_types(const cl::Kernel& kernel) {
  std::vector<std::string> types;
  for (cl_uint i = 0; i < kernel.getInfo<CL_KERNEL_NUM_ARGS>(); ++i) {
    cl_int status = CL_SUCCESS;
    std::string type = kernel.getArgInfo<CL_KERNEL_ARG_TYPE_NAME>(i, &status);
    if (status != CL_SUCCESS)
      return {};  // CL_KERNEL_ARG_INFO_NOT_AVAILABLE: some drivers lose it in binaries
    while (!type.empty() && type.back() == '\0') type.pop_back();
    types.push_back(std::move(type));
  }
  return types;
}

}  // namespace sundog
