// Launches a kernel over no work, which makes drivers compile it for a work-group size.
#include "device/empty_launch.h"

#include <fmt/format.h>

#include <sstream>

namespace sundog {

std::string to_line(const EmptyLaunch& launch) {
  std::string line = fmt::format("{} {} {}", launch.kernel, launch.local_x, launch.local_y);
  for (const std::size_t bytes : launch.argument_bytes) line += fmt::format(" {}", bytes);
  return line;
}

EmptyLaunch empty_launch_of(const std::string& line) {
  EmptyLaunch launch;
  std::istringstream in(line);
  in >> launch.kernel >> launch.local_x >> launch.local_y;
  for (std::size_t bytes = 0; in >> bytes;) launch.argument_bytes.push_back(bytes);
  return launch;
}

cl_int launch_nothing(const cl::Context& context, const cl::CommandQueue& queue, cl::Kernel& kernel,
                      const EmptyLaunch& launch) {
  std::vector<char> zeros(std::size_t{1} << 16);
  cl_int status = CL_SUCCESS;
  const cl::Buffer buffer(context, CL_MEM_READ_WRITE | CL_MEM_COPY_HOST_PTR, zeros.size(), zeros.data(),
                          &status);
  for (cl_uint i = 0; i < launch.argument_bytes.size() && status == CL_SUCCESS; ++i)
    status = launch.argument_bytes[i] == 0 ? kernel.setArg(i, buffer)
                                           : kernel.setArg(i, launch.argument_bytes[i], zeros.data());
  const cl::NDRange group =
      launch.local_y > 1 ? cl::NDRange(launch.local_x, launch.local_y) : cl::NDRange(launch.local_x);
  if (status == CL_SUCCESS) status = queue.enqueueNDRangeKernel(kernel, cl::NullRange, group, group);
  // Not clFinish: see Device::settle().
  return status == CL_SUCCESS ? queue.enqueueReadBuffer(buffer, CL_TRUE, 0, 4, zeros.data()) : status;
}

}  // namespace sundog
